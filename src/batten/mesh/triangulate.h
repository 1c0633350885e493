/// \file Polygons to triangles.
#pragma once
#include <array>
#include <vector>

#include "batten/mesh/mesh.h"

namespace batten {

/// Appends the triangles of one face of d corners, d - 2 of them, each three positions in [0, d): quads by the shorter
/// diagonal that does not fold them, larger faces by cutting ears in the plane of their average normal (a fan where no
/// ear is found). O(d^2).
void triangulate_face(const Mesh& mesh, Index face, std::vector<std::array<Index, 3>>& triangles);

/// Splits every face as triangulate_face does, vertices kept, but for diagonals between two vertices that an edge joins
/// already: a face is split otherwise where it can be. Creases, corners and attributes stay; holes and groups
/// follow their faces. The faces must be valid (see Topology).
Mesh triangulated(const Mesh& mesh);

}  // namespace batten
