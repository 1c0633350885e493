/// \file The mesh series of a mesh's own points, for sharpening and bands.
#pragma once
#include "batten/expand/mesh_series.h"

namespace batten {

/// 1 at each boundary vertex, 0 at the others, for SeriesOptions::kept.
inline Buffer<std::uint8_t> boundary_marks(const Topology& topology) {
  Buffer<std::uint8_t> marks(static_cast<std::size_t>(topology.vertex_count()), 0);
  for (Index v = 0; v < topology.vertex_count(); ++v)
    marks[v] = !topology.is_isolated(v) && topology.is_boundary_vertex(v) ? 1 : 0;
  return marks;
}

/// Options in which cotangents are those of the points.
inline SeriesOptions series_of_points(SeriesMatrix matrix, bool keep_boundary, const Topology& topology,
                                      ConstValuesRef points) {
  SeriesOptions options;
  options.matrix = matrix;
  if (matrix == SeriesMatrix::Cotangent) options.shape = points;
  if (keep_boundary) options.kept = boundary_marks(topology);
  return options;
}

}  // namespace batten
