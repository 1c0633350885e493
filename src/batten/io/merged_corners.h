/// \file Merges corners into vertices for formats that have a single index for point, normal, texture coordinates and
/// colour.
#pragma once
#include <cstdint>
#include <vector>

#include "batten/io/write_check.h"
#include "batten/mesh/mesh.h"

namespace batten::io {

struct MergedCorners {
  Buffer<Index> vertex_of_corner;  ///< -1 at the corners of hidden faces
  Buffer<Index> corner_of_vertex;  ///< one corner of each merged vertex, ascending by the mesh's vertices
};

/// Merges two corners of a vertex if all lists have equal values there. Vertices without a visible face are left out.
/// O(H log d) for vertices of d corners; 12 bytes for each corner.
MergedCorners merge_corners(const Mesh& mesh, const std::vector<CornerList>& lists, const Buffer<std::uint8_t>& hidden);

}  // namespace batten::io
