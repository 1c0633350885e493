#include "batten/limit/butterfly_normals.h"

#include <Eigen/Geometry>

#include "batten/limit/butterfly_fan.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// Calls visit(side) for each side of a vertex that has faces. The side at which the vertex's fan starts comes first.
template <typename Visit>
void for_each_side(const Topology& topology, const TopologyWalk& walk, Index vertex, const Visit& visit) {
  bool any = false;
  const bool smooth = walk.kind(vertex) != ButterflyVertex::Curve && walk.kind(vertex) != ButterflyVertex::Corner;
  topology.for_each_outgoing(vertex, [&](Index h) {
    if (smooth || !walk.is_sharp(h)) return;
    visit(side_of(walk, h));
    any = true;
  });
  if (!any) visit(side_of(walk, topology.vertex_half_edge(vertex)));
}

class Writer {
 public:
  Writer(const Topology& topology, const Scheme& scheme, ConstValuesRef points, LimitNormals& normals)
      : topology_(topology),
        points_(points),
        normals_(normals),
        kinds_(butterfly_vertices(topology, scheme)),
        masks_(scheme),
        tangents_(scheme),
        walk_(topology, kinds_) {
    regular_ = &tangents_.make(ButterflyFan::Closed, 6);
    for (Index v = 0; v < topology.vertex_count(); ++v) {
      if (topology.is_isolated(v) || kinds_[v] == ButterflyVertex::Regular) continue;
      for_each_side(topology, walk_, v, [&](const Side& side) {
        if (side.has_masks()) tangents_.make(side.shape(), side.triangles());
      });
    }
  }

  void write(Index vertex) const {
    if (topology_.is_isolated(vertex)) return;
    if (kinds_[vertex] == ButterflyVertex::Regular && write_among_regular(vertex)) return;
    const auto point_of = [&](Index v) { return point(v); };
    const ButterflyNormal normal_of(walk_, masks_, point_of);
    bool first = true;
    for_each_side(topology_, walk_, vertex, [&](const Side& side) {
      const ButterflyTangentMasks* tangents =
          side.has_masks() ? &tangents_.at(side.shape(), side.triangles()) : nullptr;
      const Eigen::Vector3d normal = normal_of(side, tangents);
      if (first) normals_.vertices.row(vertex) = normal;
      for (const Index h : side.half_edges) normals_.corners.row(h) = normal;
      first = false;
    });
  }

 private:
  using Side = ButterflySide<TopologyWalk>;

  Eigen::Vector3d point(Index vertex) const { return points_.row(vertex).transpose(); }

  /// Uses the two rings as they are. Where all neighbours are regular, one more step would not change the result.
  bool write_among_regular(Index vertex) const {
    bool regular = true;
    topology_.for_each_outgoing(
        vertex, [&](Index h) { regular = regular && kinds_[topology_.destination(h)] == ButterflyVertex::Regular; });
    if (!regular) return false;
    Eigen::Vector3d first = Eigen::Vector3d::Zero();
    Eigen::Vector3d second = Eigen::Vector3d::Zero();
    const auto add = [&](double a, double b, const Eigen::Vector3d& at) {
      first += a * at;
      second += b * at;
    };
    std::size_t j = 0;
    topology_.for_each_outgoing(vertex, [&](Index h) {
      const TwoRingMask& x = regular_->first;
      const TwoRingMask& y = regular_->second;
      const Index back = topology_.twin(topology_.next(h));
      Index ahead = topology_.twin(h);
      for (int i = 0; i < 3; ++i) ahead = topology_.twin(topology_.previous(ahead));
      add(x.edges[j], y.edges[j], point(topology_.destination(h)));
      add(x.across[j], y.across[j], point(topology_.origin(topology_.previous(back))));
      add(x.beyond[j], y.beyond[j], point(topology_.destination(ahead)));
      ++j;
    });
    const Eigen::Vector3d normal = first.cross(second).normalized();
    normals_.vertices.row(vertex) = normal;
    topology_.for_each_outgoing(vertex, [&](Index h) { normals_.corners.row(h) = normal; });
    return true;
  }

  const Topology& topology_;
  ConstValuesRef points_;
  LimitNormals& normals_;
  Buffer<ButterflyVertex> kinds_;
  ButterflyMasks masks_;
  ButterflyTangents tangents_;
  TopologyWalk walk_;
  const ButterflyTangentMasks* regular_;
};

}  // namespace

LimitNormals butterfly_normals(const Topology& topology, const Scheme& scheme, ConstValuesRef points,
                               const Progress& progress) {
  LimitNormals normals{Values::Zero(topology.vertex_count(), 3), Values::Zero(topology.half_edge_count(), 3)};
  const Writer writer(topology, scheme, points, normals);
  const auto write_block = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) writer.write(v);
  };
  parallel_for(topology.vertex_count(), write_block, kDefaultBlock, progress);
  return normals;
}

}  // namespace batten
