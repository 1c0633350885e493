/// \file An order of the vertices in which neighbours stand near each other.
#pragma once
#include "batten/buffer.h"
#include "batten/mesh/topology.h"

namespace batten {

/// All vertices, component by component: the lowest, then breadth-first all others, from each to those of its faces. A
/// sparse matrix over the vertices becomes a band in this order (after Cuthill and McKee 1969, key CM69), as wide as a
/// ring of vertices at the same distance. O(H).
Buffer<Index> breadth_first_vertices(const Topology& topology);

}  // namespace batten
