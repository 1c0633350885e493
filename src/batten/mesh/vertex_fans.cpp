#include "batten/mesh/vertex_fans.h"

#include "batten/parallel/parallel.h"

namespace batten {

Buffer<Index> vertex_face_counts(const Topology& topology) {
  Buffer<Index> counts;
  counts.assign(static_cast<std::size_t>(topology.vertex_count()), 0);
  const Buffer<Index>& origins = topology.tables().origins;
  parallel_for(static_cast<std::ptrdiff_t>(origins.size()), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t h = begin; h < end; ++h) atomic_add(counts[origins[h]], 1);
  });
  return counts;
}

}  // namespace batten
