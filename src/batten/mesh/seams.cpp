#include "batten/mesh/seams.h"

#include <unordered_map>
#include <utility>

#include "batten/mesh/places.h"

namespace batten {

namespace {

/// An open edge, by the places of its ends.
struct OpenEdge {
  Index a;  ///< row of the boundary vertices
  Index b;
  std::uint64_t places;  ///< the same for edges with the same two ends
};

Buffer<Index> boundary_vertices(const Topology& topology) {
  Buffer<Index> vertices;
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (!topology.is_isolated(v) && topology.is_boundary_vertex(v)) vertices.push_back(v);
  }
  return vertices;
}

std::uint64_t pair_key(Index a, Index b) {
  if (a > b) std::swap(a, b);
  return static_cast<std::uint64_t>(a) << 32U | static_cast<std::uint32_t>(b);
}

}  // namespace

Index coincident_boundary_count(const Topology& topology, const Points& points) {
  require_vertex_rows(topology, points);
  const Buffer<Index> vertices = boundary_vertices(topology);
  if (vertices.empty()) return 0;
  const Buffer<Index> first = first_equal(points, vertices);
  Buffer<Index> row_of(static_cast<std::size_t>(topology.vertex_count()));
  for (std::size_t i = 0; i < vertices.size(); ++i) row_of[vertices[i]] = static_cast<Index>(i);
  std::vector<OpenEdge> edges;
  std::unordered_map<std::uint64_t, Index> counts;
  for (Index i = 0; i < static_cast<Index>(vertices.size()); ++i) {
    // A boundary vertex's first half-edge runs along the boundary.
    const Index next = row_of[topology.destination(topology.vertex_half_edge(vertices[i]))];
    if (first[i] == first[next]) continue;
    edges.push_back({i, next, pair_key(first[i], first[next])});
    ++counts[edges.back().places];
  }
  // The rows on seams, and the places that have one.
  Buffer<std::uint8_t> on_seam(vertices.size(), 0);
  Buffer<std::uint8_t> met(vertices.size(), 0);
  for (const OpenEdge& edge : edges) {
    if (counts[edge.places] > 1) on_seam[edge.a] = on_seam[edge.b] = 1;
  }
  Index count = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (on_seam[i] == 0) continue;
    count += met[first[i]] != 0 ? 1 : 0;
    met[first[i]] = 1;
  }
  return count;
}

}  // namespace batten
