#include "batten/fit/crease_counts.h"

#include <vector>

namespace batten {

CreaseCounts count_creases(const Topology& topology) {
  CreaseCounts counts;
  std::vector<Index> at(static_cast<std::size_t>(topology.vertex_count()), 0);
  for (Index e = 0; e < topology.edge_count(); ++e) {
    if (topology.is_boundary_edge(e) || !(topology.edge_sharpness(e) > 0.0F)) continue;
    ++counts.edges;
    const Index h = topology.edge_half_edge(e);
    ++at[topology.origin(h)];
    ++at[topology.destination(h)];
  }
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (topology.is_isolated(v)) continue;
    if (at[v] > 2 || topology.vertex_sharpness(v) > 0.0F) ++counts.corners;
    if (at[v] == 1 && !topology.is_boundary_vertex(v)) ++counts.darts;
  }
  return counts;
}

}  // namespace batten
