#include "batten/limit/butterfly_normals.h"

#include <Eigen/Geometry>

#include "batten/limit/butterfly_tangents.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// Outgoing half-edges of a vertex, counter-clockwise; those of a dart from its sharp edge on.
struct Fan {
  ButterflyVertex kind;
  Buffer<Index> half_edges;

  int triangles() const { return static_cast<int>(half_edges.size()); }
  bool closed() const { return kind != ButterflyVertex::Curve && kind != ButterflyVertex::Corner; }
  ButterflyFan shape() const {
    if (kind == ButterflyVertex::Curve) return ButterflyFan::Curve;
    return kind == ButterflyVertex::Dart ? ButterflyFan::Dart : ButterflyFan::Closed;
  }
  /// Corners are cones; two triangles that share two edges have no tangent plane.
  bool has_masks() const { return kind != ButterflyVertex::Corner && !(closed() && triangles() < 3); }
};

/// Calls visit(fan) for each side of a vertex that has faces.
template <typename Visit>
void for_each_fan(const Topology& topology, const TopologyWalk& walk, Index vertex, const Visit& visit) {
  Buffer<Index> outgoing;
  topology.for_each_outgoing(vertex, [&](Index h) { outgoing.push_back(h); });
  const auto count = outgoing.size();
  std::size_t start = 0;
  while (start < count && !walk.is_sharp(outgoing[start])) ++start;
  Fan fan{walk.kind(vertex), {}};
  if (start == count) start = 0;  // no sharp edge
  for (std::size_t i = 0; i < count; ++i) {
    const Index h = outgoing[(start + i) % count];
    if (!fan.closed() && walk.is_sharp(h) && !fan.half_edges.empty()) {
      visit(fan);
      fan.half_edges.clear();
    }
    fan.half_edges.push_back(h);
  }
  visit(fan);
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
        walk_(topology, kinds_),
        rules_(walk_, masks_) {
    regular_ = &tangents_.make(ButterflyFan::Closed, 6);
    for (Index v = 0; v < topology.vertex_count(); ++v) {
      if (topology.is_isolated(v) || kinds_[v] == ButterflyVertex::Regular) continue;
      for_each_fan(topology, walk_, v, [&](const Fan& fan) {
        if (fan.has_masks()) tangents_.make(fan.shape(), fan.triangles());
      });
    }
  }

  void write(Index vertex) const {
    if (topology_.is_isolated(vertex)) return;
    if (kinds_[vertex] == ButterflyVertex::Regular && write_among_regular(vertex)) return;
    bool first = true;
    for_each_fan(topology_, walk_, vertex, [&](const Fan& fan) {
      const Eigen::Vector3d normal = normal_of(vertex, fan);
      if (first) normals_.vertices.row(vertex) = normal;
      for (const Index h : fan.half_edges) normals_.corners.row(h) = normal;
      first = false;
    });
  }

 private:
  Eigen::Vector3d point(Index vertex) const { return points_.row(vertex).transpose(); }
  Eigen::Vector3d new_point(Index half_edge) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    rules_.visit(half_edge, [&](Index vertex, double weight) { sum += weight * point(vertex); });
    return sum;
  }

  /// The two rings as they are, where all neighbours are regular: one more step would change nothing.
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

  Eigen::Vector3d normal_of(Index vertex, const Fan& fan) const {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    if (fan.has_masks()) {
      const ButterflyTangentMasks& masks = tangents_.at(fan.shape(), fan.triangles());
      const Eigen::Vector3d first = tangent(vertex, fan, masks.first);
      const Eigen::Vector3d second = tangent(vertex, fan, masks.second);
      normal = first.cross(second);
      if (!(normal.norm() > kParallel * first.norm() * second.norm())) normal.setZero();
    }
    if (normal.isZero(0.0)) normal = cone_normal(vertex, fan);
    const double length = normal.norm();
    return length > 0.0 ? Eigen::Vector3d(normal / length) : Eigen::Vector3d(Eigen::Vector3d::Zero());
  }

  Eigen::Vector3d tangent(Index vertex, const Fan& fan, const TwoRingMask& mask) const {
    Eigen::Vector3d sum = mask.vertex * point(vertex);
    for (int j = 0; j < fan.triangles(); ++j) {
      const Index h = fan.half_edges[j];
      add_edge(mask, static_cast<std::size_t>(j), h, topology_.destination(h), sum);
      if (!mask.across.empty()) sum += mask.across[j] * new_point(topology_.next(h));
    }
    if (fan.closed()) return sum;
    const Index last = topology_.previous(fan.half_edges.back());
    add_edge(mask, static_cast<std::size_t>(fan.triangles()), last, topology_.origin(last), sum);
    return sum;
  }

  /// One step on, e_j is the new point of the edge and d_j the neighbour that e_j was.
  void add_edge(const TwoRingMask& mask, std::size_t j, Index half_edge, Index neighbour, Eigen::Vector3d& sum) const {
    if (mask.edges[j] != 0.0) sum += mask.edges[j] * new_point(half_edge);
    if (!mask.beyond.empty() && mask.beyond[j] != 0.0) sum += mask.beyond[j] * point(neighbour);
  }

  /// Every edge at a corner is a curve that ends there: the cone of their tangents, its triangles weighted by area.
  Eigen::Vector3d cone_normal(Index vertex, const Fan& fan) const {
    const double after = 2.0 * masks_.curve_end().after;
    const auto end_tangent = [&](Index h, Index neighbour) -> Eigen::Vector3d {
      return new_point(h) + after * point(neighbour) - (1.0 + after) * point(vertex);
    };
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Index h : fan.half_edges) {
      const Index last = topology_.previous(h);
      sum += end_tangent(h, topology_.destination(h)).cross(end_tangent(last, topology_.origin(last)));
    }
    return sum;
  }

  /// The sine below which two tangents are one: where Butterfly is not smooth both masks are its first eigenvector.
  static constexpr double kParallel = 1e-9;

  const Topology& topology_;
  ConstValuesRef points_;
  LimitNormals& normals_;
  Buffer<ButterflyVertex> kinds_;
  ButterflyMasks masks_;
  ButterflyTangents tangents_;
  TopologyWalk walk_;
  ButterflyRules<TopologyWalk> rules_;
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
