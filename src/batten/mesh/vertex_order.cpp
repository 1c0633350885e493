#include "batten/mesh/vertex_order.h"

#include <cstdint>

namespace batten {

Buffer<Index> breadth_first_vertices(const Topology& topology) {
  const auto count = static_cast<std::size_t>(topology.vertex_count());
  Buffer<Index> order;
  order.reserve(count);
  Buffer<std::uint8_t> seen(count, 0);
  Buffer<std::uint8_t> face_seen(static_cast<std::size_t>(topology.face_count()), 0);
  const auto add = [&](Index vertex) {
    if (seen[vertex] != 0) return;
    seen[vertex] = 1;
    order.push_back(vertex);
  };
  for (Index start = 0; start < topology.vertex_count(); ++start) {
    std::size_t next = order.size();
    add(start);
    for (; next < order.size(); ++next) {
      if (topology.is_isolated(order[next])) continue;
      topology.for_each_outgoing(order[next], [&](Index half_edge) {
        const Index face = topology.face(half_edge);
        if (face_seen[face] != 0) return;
        face_seen[face] = 1;
        for (Index h = topology.face_begin(face); h < topology.face_end(face); ++h) add(topology.origin(h));
      });
    }
  }
  return order;
}

}  // namespace batten
