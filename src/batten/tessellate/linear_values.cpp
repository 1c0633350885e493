#include "batten/tessellate/linear_values.h"

#include <algorithm>

#include "batten/parallel/parallel.h"
#include "batten/tessellate/linear_in_face.h"

namespace batten {

namespace {

/// Of the points on edges, a face fills those of its own lower half-edges; those at vertices are there.
bool fills(const Topology& base, const GridPoint& at) {
  if (at.half_edge < 0) return true;
  return at.from_origin > 0 && base.edge_half_edge(base.edge(at.half_edge)) == at.half_edge;
}

}  // namespace

Values linear_values(const Topology& base, const TessellationLayout& layout, ConstValuesRef values,
                     const Progress& progress) {
  constexpr std::int64_t kPointsPerBlock = 16384;
  Values result(layout.vertices, values.cols());
  result.topRows(base.vertex_count()) = values;
  const auto fill = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      const auto corner = [&](Index c) { return values.row(base.origin(base.face_begin(f) + c)); };
      for (Index j = 0; j <= layout.steps; ++j) {
        for (Index i = 0; i < layout.row_length(j); ++i) {
          if (!fills(base, layout.locate(base, f, i, j))) continue;
          const double u = static_cast<double>(i) / layout.steps;
          const double v = static_cast<double>(j) / layout.steps;
          set_linear(layout.quads, u, v, corner, result.row(layout.vertex(base, f, i, j)));
        }
      }
    }
  };
  parallel_for(base.face_count(), fill, std::max<std::ptrdiff_t>(1, kPointsPerBlock / layout.faces_per_face), progress);
  return result;
}

}  // namespace batten
