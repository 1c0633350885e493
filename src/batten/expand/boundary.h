/// \file The vertices at the boundary, for SeriesOptions::kept.
#pragma once
#include "batten/mesh/topology.h"

namespace batten {

/// 1 at each vertex of a boundary, 0 at the others.
inline Buffer<std::uint8_t> boundary_marks(const Topology& topology) {
  Buffer<std::uint8_t> marks(static_cast<std::size_t>(topology.vertex_count()), 0);
  for (Index v = 0; v < topology.vertex_count(); ++v)
    marks[v] = !topology.is_isolated(v) && topology.is_boundary_vertex(v) ? 1 : 0;
  return marks;
}

}  // namespace batten
