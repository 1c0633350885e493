/// \file A mesh whose vertices stand elsewhere.
#pragma once
#include "batten/mesh/mesh.h"

namespace batten {

/// The mesh with other points, V-by-3; "normal" attributes, which belonged to the old points, are left out.
/// Throws Error(BadShape).
Mesh with_points(const Mesh& mesh, ConstValuesRef points);

}  // namespace batten
