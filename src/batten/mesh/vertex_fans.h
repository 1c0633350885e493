/// \file Walks around vertices, for loops over a whole mesh.
#pragma once
#include "batten/mesh/topology.h"

namespace batten {

/// The half-edge before another in its face. Where all faces are triangles, or all are quads, no table is read: in a
/// walk around a vertex that spares two of four reads far apart in memory.
inline Index previous_half_edge(const TopologyTables& tables, Index h) {
  if (tables.uniform_face_size == 4) return (h & ~3) | ((h + 3) & 3);
  if (tables.uniform_face_size == 3) return h % 3 == 0 ? h + 2 : h - 1;
  const Index f = tables.faces[h];
  return h == tables.face_offsets[f] ? tables.face_offsets[f + 1] - 1 : h - 1;
}

/// The half-edge after another in its face, found in the same way.
inline Index next_half_edge(const TopologyTables& tables, Index h) {
  if (tables.uniform_face_size == 4) return (h & ~3) | ((h + 1) & 3);
  if (tables.uniform_face_size == 3) return h % 3 == 2 ? h - 2 : h + 1;
  const Index f = tables.faces[h];
  return h + 1 == tables.face_offsets[f + 1] ? tables.face_offsets[f] : h + 1;
}

/// Calls visit(h, destination of h) for the half-edges of Topology::for_each_outgoing, in its order.
template <typename Visit>
void for_each_spoke(const Topology& topology, Index vertex, const Visit& visit) {
  const TopologyTables& tables = topology.tables();
  const Index start = tables.vertex_half_edges[vertex];
  for (Index h = start; h >= 0;) {
    visit(h, tables.origins[next_half_edge(tables, h)]);
    h = tables.twins[previous_half_edge(tables, h)];
    if (h == start) break;
  }
}

/// The number of faces at each vertex, as Topology::vertex_face_count gives it. Counting corners costs a tenth of
/// walking around every vertex. O(V + H), V numbers.
Buffer<Index> vertex_face_counts(const Topology& topology);

}  // namespace batten
