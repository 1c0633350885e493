#include "batten/fit/fit_levels.h"

#include "batten/refine/refined_values.h"

namespace batten {

Index most_fit_vertices(const FitOptions& options) {
  return options.vertices.value_or(options.initial ? 0 : kUsualFitVertices);
}

int fit_level_count(const Topology& topology, SchemeKind kind, Index most) {
  constexpr double kOfRefinement = 4.0;
  int levels = 1;
  for (double count = refined_vertex_count(topology, kind); count <= most; count *= kOfRefinement) ++levels;
  return levels;
}

}  // namespace batten
