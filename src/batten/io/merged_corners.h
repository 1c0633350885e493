/// \file Corners made into the vertices of a format that has one index for all: point, normal, texture and colour.
#pragma once
#include <cstdint>
#include <vector>

#include "batten/io/write_check.h"
#include "batten/mesh/mesh.h"

namespace batten::io {

struct MergedCorners {
  Buffer<Index> vertex_of_corner;  ///< -1 at the corners of hidden faces
  Buffer<Index> corner_of_vertex;  ///< one corner of each merged vertex; ascending by the mesh's vertices
};

/// Two corners at the same vertex become one where all lists have equal values there. Vertices without a visible face
/// are left out. O(H log d) at vertices of d corners; 12 bytes a corner.
MergedCorners merge_corners(const Mesh& mesh, const std::vector<CornerList>& lists, const Buffer<std::uint8_t>& hidden);

}  // namespace batten::io
