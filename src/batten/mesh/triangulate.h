/// \file Splits polygons into triangles.
#pragma once
#include <array>
#include <vector>

#include "batten/mesh/mesh.h"

namespace batten {

/// Appends the d - 2 triangles of one face of d corners, each as three positions in [0, d). Quads are split by the
/// shorter diagonal that does not fold them, larger faces by cutting ears in the plane of their average normal (a fan
/// if no ear is found). O(d^2).
void triangulate_face(const Mesh& mesh, Index face, std::vector<std::array<Index, 3>>& triangles);

/// Splits every face as triangulate_face does and keeps the vertices. A diagonal between two vertices that are already
/// joined by an edge is avoided where possible. Creases, corners and attributes are kept; holes and groups follow their
/// faces. The faces must be valid (see Topology).
Mesh triangulated(const Mesh& mesh);

}  // namespace batten
