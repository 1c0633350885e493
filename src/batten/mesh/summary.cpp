#include "batten/mesh/summary.h"

#include <algorithm>
#include <utility>

#include "batten/mesh/vertex_fans.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// Walks the boundary loops and counts them and their edges.
void count_boundaries(const Topology& topology, const Components& components, std::vector<ComponentSummary>& all) {
  Buffer<std::uint8_t> met(static_cast<std::size_t>(topology.vertex_count()), 0);
  for (Index e = 0; e < topology.edge_count(); ++e) {
    if (!topology.is_boundary_edge(e)) continue;
    const Index start = topology.origin(topology.edge_half_edge(e));
    ComponentSummary& component = all[components.of_vertex[start]];
    ++component.boundary_edges;
    if (met[start] != 0) continue;
    ++component.boundary_loops;
    // A boundary vertex's first half-edge runs along the boundary.
    for (Index v = start; met[v] == 0; v = topology.destination(topology.vertex_half_edge(v))) met[v] = 1;
  }
}

void count_components(const Topology& topology, const Components& components, MeshSummary& summary) {
  std::vector<ComponentSummary> all(static_cast<std::size_t>(components.count));
  const auto of = [&](Index vertex) -> ComponentSummary& { return all[components.of_vertex[vertex]]; };
  if (components.count == 1) {
    all[0] = {0, topology.vertex_count(), topology.edge_count(), topology.face_count()};
  } else {
    for (Index v = 0; v < topology.vertex_count(); ++v) {
      if (of(v).vertices++ == 0) of(v).first_vertex = v;
    }
    for (Index f = 0; f < topology.face_count(); ++f) ++of(topology.origin(topology.face_begin(f))).faces;
    for (Index e = 0; e < topology.edge_count(); ++e) ++of(topology.origin(topology.edge_half_edge(e))).edges;
  }
  count_boundaries(topology, components, all);
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

using Histogram = std::map<Index, Index>;

void add_counts(Histogram& a, const Histogram& b) {
  for (const auto& entry : b) a[entry.first] += entry.second;
}

void count_valences(const Topology& topology, MeshSummary& summary) {
  struct Part {
    Histogram inside;
    Histogram at_boundary;
  };
  const Buffer<Index> counts = vertex_face_counts(topology);
  Part all = parallel_reduce(
      topology.vertex_count(), Part(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Part part;
        for (auto v = static_cast<Index>(begin); v < end; ++v) {
          if (topology.is_isolated(v)) continue;
          const bool open = topology.is_boundary_vertex(v);
          ++(open ? part.at_boundary : part.inside)[counts[v] + (open ? 1 : 0)];
        }
        return part;
      },
      [](Part a, const Part& b) {
        add_counts(a.inside, b.inside);
        add_counts(a.at_boundary, b.at_boundary);
        return a;
      });
  summary.valences = std::move(all.inside);
  summary.boundary_valences = std::move(all.at_boundary);
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

MeshSummary summarize(const Topology& topology) { return summarize(topology, connected_components(topology)); }

MeshSummary summarize(const Topology& topology, const Components& components) {
  MeshSummary summary;
  count_components(topology, components, summary);
  count_valences(topology, summary);
  count_sharpness(topology, summary);
  return summary;
}

}  // namespace batten
