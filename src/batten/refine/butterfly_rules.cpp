#include "batten/refine/butterfly_rules.h"

#include <algorithm>

#include "batten/parallel/parallel.h"
#include "batten/refine/vertex_blend.h"

namespace batten {

namespace {

ButterflyVertex kind_of(const Topology& topology, const Scheme& scheme, Index vertex) {
  if (topology.is_isolated(vertex) || is_sharp(vertex_sharpness(topology, scheme, vertex))) {
    return ButterflyVertex::Corner;
  }
  int edges = 0;
  // No outgoing half-edge belongs to the incoming edge of the boundary.
  int sharp = topology.is_boundary_vertex(vertex) ? 1 : 0;
  topology.for_each_outgoing(vertex, [&](Index h) {
    ++edges;
    sharp += is_sharp(topology.edge_sharpness(topology.edge(h))) ? 1 : 0;
  });
  if (sharp > 2) return ButterflyVertex::Corner;
  if (sharp == 2) return ButterflyVertex::Curve;
  if (sharp == 1) return ButterflyVertex::Dart;
  return edges == 6 ? ButterflyVertex::Regular : ButterflyVertex::Extraordinary;
}

void collect(const ButterflyRules<TopologyWalk>& rules, Index half_edge, ButterflyPoint& point) {
  point.vertices.clear();
  point.weights.clear();
  rules.visit(half_edge, [&](Index vertex, double weight) {
    point.vertices.push_back(vertex);
    point.weights.push_back(weight);
  });
}

/// Sums the rows of a stencil, a few columns at a time.
template <typename Scalar>
void sum_rows(const ButterflyPoint& point, ConstValuesRef values, Scalar* out) {
  constexpr std::ptrdiff_t kColumns = 3;
  const std::ptrdiff_t k = values.cols();
  const std::ptrdiff_t stride = values.outerStride();
  for (std::ptrdiff_t c = 0; c < k; c += kColumns) {
    const std::ptrdiff_t width = std::min(kColumns, k - c);
    double sum[kColumns] = {};
    for (std::size_t i = 0; i < point.vertices.size(); ++i) {
      const double* row = values.data() + point.vertices[i] * stride + c;
      for (std::ptrdiff_t j = 0; j < width; ++j) sum[j] += point.weights[i] * row[j];
    }
    for (std::ptrdiff_t j = 0; j < width; ++j) out[c + j] = static_cast<Scalar>(sum[j]);
  }
}

}  // namespace

Buffer<ButterflyVertex> butterfly_vertices(const Topology& topology, const Scheme& scheme) {
  Buffer<ButterflyVertex> kinds(static_cast<std::size_t>(topology.vertex_count()));
  parallel_for(topology.vertex_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) kinds[v] = kind_of(topology, scheme, v);
  });
  return kinds;
}

ButterflyPoint butterfly_point(const Topology& topology, const Buffer<ButterflyVertex>& kinds,
                               const ButterflyMasks& masks, Index edge) {
  const TopologyWalk walk(topology, kinds);
  ButterflyPoint point;
  collect(ButterflyRules(walk, masks), topology.edge_half_edge(edge), point);
  return point;
}

template <typename Scalar>
void refine_butterfly_values(const Topology& topology, const Scheme& scheme, ConstValuesRef values, Scalar* out,
                             const Progress& progress) {
  const Buffer<ButterflyVertex> kinds = butterfly_vertices(topology, scheme);
  const ButterflyMasks masks(scheme);
  const TopologyWalk walk(topology, kinds);
  const ButterflyRules rules(walk, masks);
  const std::ptrdiff_t k = values.cols();
  const std::ptrdiff_t kept = topology.vertex_count();
  parallel_for(kept, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t v = begin; v < end; ++v) {
      for (std::ptrdiff_t c = 0; c < k; ++c) out[v * k + c] = static_cast<Scalar>(values(v, c));
    }
  });
  parallel_for(
      topology.edge_count(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        ButterflyPoint point;
        for (auto e = static_cast<Index>(begin); e < end; ++e) {
          collect(rules, topology.edge_half_edge(e), point);
          sum_rows(point, values, out + (kept + e) * k);
        }
      },
      kDefaultBlock, progress);
}

template void refine_butterfly_values(const Topology&, const Scheme&, ConstValuesRef, float*, const Progress&);
template void refine_butterfly_values(const Topology&, const Scheme&, ConstValuesRef, double*, const Progress&);

}  // namespace batten
