/// \file Numbers at a mesh's vertices that its connectivity and its tags give.
#pragma once
#include "batten/mesh/topology.h"

namespace batten {

/// The vertices without a face. O(V).
Index isolated_count(const Topology& topology);

/// The edges at each vertex; at a boundary vertex twice its faces, so that a regular vertex has 4 on quads and 6 on
/// triangles there too. 0 at a vertex without a face. V numbers. O(H).
Scalars vertex_valences(const Topology& topology);

/// The sharpness of an edge inside the mesh, at most kInfiniteSharpness; 0 on a boundary, which is no crease.
double crease_sharpness(const Topology& topology, Index edge);

/// The greatest sharpness at each vertex, of its creases and its own, at most kInfiniteSharpness. V numbers. O(V + E).
Scalars vertex_sharpnesses(const Topology& topology);

/// Gives each vertex whose number is NaN the mean over those neighbours along edges that have one; without such a
/// neighbour it stays NaN. Faces have `face_size` entries of face_vertices each; field: a number a vertex. O(corners).
void fill_from_neighbours(Index face_size, const Buffer<Index>& face_vertices, Scalars& field);
/// The same along the edges of a topology whose faces have any size.
void fill_from_neighbours(const Topology& topology, Scalars& field);

}  // namespace batten
