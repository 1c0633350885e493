#include "batten/mesh/vertex_fields.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "batten/mesh/vertex_fans.h"

namespace batten {

Index isolated_count(const Topology& topology) {
  const Buffer<Index>& starts = topology.tables().vertex_half_edges;
  return static_cast<Index>(std::count(starts.begin(), starts.end(), -1));
}

Scalars vertex_valences(const Topology& topology) {
  Scalars field = Scalars::Zero(topology.vertex_count());
  const Buffer<Index> counts = vertex_face_counts(topology);
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (topology.is_isolated(v)) continue;
    field[v] = (topology.is_boundary_vertex(v) ? 2.0 : 1.0) * counts[v];
  }
  return field;
}

double crease_sharpness(const Topology& topology, Index edge) {
  if (topology.is_boundary_edge(edge)) return 0.0;
  return std::min(topology.edge_sharpness(edge), kInfiniteSharpness);
}

Scalars vertex_sharpnesses(const Topology& topology) {
  Scalars field = Scalars::Zero(topology.vertex_count());
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    field[v] = std::min(topology.vertex_sharpness(v), kInfiniteSharpness);
  }
  for (Index e = 0; e < topology.edge_count(); ++e) {
    const Index h = topology.edge_half_edge(e);
    for (const Index v : {topology.origin(h), topology.destination(h)}) {
      field[v] = std::max(field[v], crease_sharpness(topology, e));
    }
  }
  return field;
}

namespace {

/// Vertices without a number, each with a neighbour that has one.
using NumberedNeighbours = std::vector<std::pair<Index, Index>>;

void note_edge(Index a, Index b, const Scalars& field, NumberedNeighbours& neighbours) {
  if (std::isnan(field[a]) && !std::isnan(field[b])) neighbours.emplace_back(a, b);
  if (std::isnan(field[b]) && !std::isnan(field[a])) neighbours.emplace_back(b, a);
}

/// An edge may have been noted more than once.
void fill_means(NumberedNeighbours& neighbours, Scalars& field) {
  std::sort(neighbours.begin(), neighbours.end());
  neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
  for (std::size_t begin = 0; begin < neighbours.size();) {
    std::size_t end = begin;
    double sum = 0.0;
    for (; end < neighbours.size() && neighbours[end].first == neighbours[begin].first; ++end) {
      sum += field[neighbours[end].second];
    }
    field[neighbours[begin].first] = sum / static_cast<double>(end - begin);
    begin = end;
  }
}

}  // namespace

void fill_from_neighbours(Index face_size, const Buffer<Index>& face_vertices, Scalars& field) {
  NumberedNeighbours neighbours;
  const auto size = static_cast<std::size_t>(face_size);
  for (std::size_t first = 0; first < face_vertices.size(); first += size) {
    for (std::size_t k = 0; k < size; ++k)
      note_edge(face_vertices[first + k], face_vertices[first + (k + 1 == size ? 0 : k + 1)], field, neighbours);
  }
  fill_means(neighbours, field);
}

void fill_from_neighbours(const Topology& topology, Scalars& field) {
  NumberedNeighbours neighbours;
  for (Index edge = 0; edge < topology.edge_count(); ++edge) {
    const Index h = topology.edge_half_edge(edge);
    note_edge(topology.origin(h), topology.destination(h), field, neighbours);
  }
  fill_means(neighbours, field);
}

}  // namespace batten
