#include "batten/fit/fit_levels.h"

#include <cstdint>

#include "batten/refine/refined_values.h"

namespace batten {

Index most_fit_vertices(const FitOptions& options) {
  return options.vertices.value_or(options.initial ? 0 : kUsualFitVertices);
}

int fit_level_count(const Topology& topology, SchemeKind kind, Index most) {
  constexpr std::int64_t kOfRefinement = 4;
  int levels = 1;
  for (std::int64_t count = refined_vertex_count(topology, kind); count <= most; count *= kOfRefinement) ++levels;
  return levels;
}

}  // namespace batten
