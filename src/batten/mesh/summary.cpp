#include "batten/mesh/summary.h"

#include <algorithm>

namespace batten {

namespace {

void count_components(const Topology& topology, MeshSummary& summary) {
  const Components components = connected_components(topology);
  std::vector<ComponentSummary> all(static_cast<std::size_t>(components.count));
  const auto of = [&](Index vertex) -> ComponentSummary& { return all[components.of_vertex[vertex]]; };
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (of(v).vertices++ == 0) of(v).first_vertex = v;
  }
  for (Index f = 0; f < topology.face_count(); ++f) ++of(topology.origin(topology.face_begin(f))).faces;
  Buffer<std::uint8_t> met(static_cast<std::size_t>(topology.vertex_count()), 0);
  for (Index e = 0; e < topology.edge_count(); ++e) {
    const Index start = topology.origin(topology.edge_half_edge(e));
    ++of(start).edges;
    if (!topology.is_boundary_edge(e)) continue;
    ++of(start).boundary_edges;
    if (met[start] != 0) continue;
    ++of(start).boundary_loops;
    // A boundary vertex's first half-edge runs along the boundary.
    for (Index v = start; met[v] == 0; v = topology.destination(topology.vertex_half_edge(v))) met[v] = 1;
  }
  for (const ComponentSummary& component : all) {
    if (component.faces == 0) {
      ++summary.isolated_vertices;
      continue;
    }
    summary.boundary_edges += component.boundary_edges;
    summary.boundary_loops += component.boundary_loops;
    summary.components.push_back(component);
  }
}

void count_sharpness(const Topology& topology, MeshSummary& summary) {
  if (!topology.has_creases()) return;
  Buffer<Index> sharp_at(static_cast<std::size_t>(topology.vertex_count()), 0);
  for (Index e = 0; e < topology.edge_count(); ++e) {
    const float sharpness = topology.edge_sharpness(e);
    if (sharpness <= 0.0F || topology.is_boundary_edge(e)) continue;
    const Index h = topology.edge_half_edge(e);
    ++sharp_at[topology.origin(h)];
    ++sharp_at[topology.destination(h)];
    summary.least_sharpness = summary.sharp_edges == 0 ? sharpness : std::min(summary.least_sharpness, sharpness);
    summary.most_sharpness = std::max(summary.most_sharpness, sharpness);
    ++summary.sharp_edges;
    summary.semi_sharp_edges += sharpness < kInfiniteSharpness ? 1 : 0;
  }
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    summary.darts += sharp_at[v] == 1 && !topology.is_boundary_vertex(v) ? 1 : 0;
  }
}

}  // namespace

MeshSummary summarize(const Topology& topology) {
  MeshSummary summary;
  count_components(topology, summary);
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (topology.is_isolated(v)) continue;
    const bool open = topology.is_boundary_vertex(v);
    ++(open ? summary.boundary_valences : summary.valences)[topology.vertex_face_count(v) + (open ? 1 : 0)];
  }
  count_sharpness(topology, summary);
  return summary;
}

}  // namespace batten
