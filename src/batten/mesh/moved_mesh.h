/// \file A mesh whose vertices stand elsewhere, and two meshes that differ in nothing else.
#pragma once
#include "batten/mesh/mesh.h"

namespace batten {

/// The mesh with other points, V-by-3; "normal" attributes, which belonged to the old points, are left out.
/// Throws Error(BadShape).
Mesh with_points(const Mesh& mesh, ConstValuesRef points);

/// Throws Error(BadShape), naming the first difference, unless both have the same number of vertices and the same faces
/// in the same order. A face may start at another of its vertices.
void require_same_connectivity(const Mesh& a, const Mesh& b);

}  // namespace batten
