/// \file Limit normals of the Butterflies on one side of a vertex, for any connectivity that their rules can walk
/// (refine/butterfly_rules.h).
#pragma once
#include <Eigen/Geometry>

#include "batten/limit/butterfly_tangents.h"

namespace batten {

/// One side of a vertex as outgoing half-edges, counter-clockwise. A smooth vertex has one side with all its triangles,
/// a dart one that starts at its sharp edge, and any other vertex one between each two neighbouring sharp edges.
template <typename Walk>
struct ButterflySide {
  ButterflyVertex kind;
  std::vector<typename Walk::HalfEdge> half_edges;

  int triangles() const { return static_cast<int>(half_edges.size()); }
  bool closed() const { return kind != ButterflyVertex::Curve && kind != ButterflyVertex::Corner; }
  ButterflyFan shape() const {
    if (kind == ButterflyVertex::Curve) return ButterflyFan::Curve;
    return kind == ButterflyVertex::Dart ? ButterflyFan::Dart : ButterflyFan::Closed;
  }
  /// A corner is a cone, and two triangles that share two edges have no tangent plane.
  bool has_masks() const { return kind != ButterflyVertex::Corner && !(closed() && triangles() < 3); }
};

/// The side of h's origin to which h belongs.
template <typename Walk>
ButterflySide<Walk> side_of(const Walk& walk, typename Walk::HalfEdge h) {
  ButterflySide<Walk> side{walk.kind(walk.origin(h)), {}};
  const bool smooth = side.kind == ButterflyVertex::Regular || side.kind == ButterflyVertex::Extraordinary;
  auto start = h;
  while (!smooth && !walk.is_sharp(start)) {
    start = walk.next(walk.twin(start));
    if (start == h) break;  // a corner without sharp edges
  }
  auto g = start;
  do {
    side.half_edges.push_back(g);
    const auto last = walk.previous(g);
    if (!side.closed() && walk.is_sharp(last)) break;
    g = walk.twin(last);
  } while (!(g == start));
  return side;
}

/// The unit normal, or zero where there is none. point(vertex) returns the position of a vertex of the walk.
template <typename Walk, typename Point>
class ButterflyNormal {
 public:
  ButterflyNormal(const Walk& walk, const ButterflyMasks& masks, const Point& point)
      : walk_(walk), masks_(masks), rules_(walk, masks), point_(point) {}

  /// tangents: the masks for the side's shape, or null if it has none.
  Eigen::Vector3d operator()(const ButterflySide<Walk>& side, const ButterflyTangentMasks* tangents) const {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    if (tangents != nullptr) {
      const Eigen::Vector3d first = tangent(side, tangents->first);
      const Eigen::Vector3d second = tangent(side, tangents->second);
      normal = first.cross(second);
      if (!(normal.norm() > kParallel * first.norm() * second.norm())) normal.setZero();
    }
    if (normal.isZero(0.0)) normal = cone_normal(side);
    const double length = normal.norm();
    return length > 0.0 ? Eigen::Vector3d(normal / length) : Eigen::Vector3d(Eigen::Vector3d::Zero());
  }

 private:
  using HalfEdge = typename Walk::HalfEdge;
  /// Tangents are parallel below this sine. Where Butterfly is not smooth, both masks are the first eigenvector.
  static constexpr double kParallel = 1e-9;

  Eigen::Vector3d new_point(const HalfEdge& half_edge) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    rules_.visit(half_edge, [&](const auto& vertex, double weight) { sum += weight * point_(vertex); });
    return sum;
  }
  auto destination(const HalfEdge& h) const { return walk_.origin(walk_.next(h)); }

  Eigen::Vector3d tangent(const ButterflySide<Walk>& side, const TwoRingMask& mask) const {
    Eigen::Vector3d sum = mask.vertex * point_(walk_.origin(side.half_edges.front()));
    for (int j = 0; j < side.triangles(); ++j) {
      const HalfEdge& h = side.half_edges[j];
      add_edge(mask, static_cast<std::size_t>(j), h, destination(h), sum);
      if (!mask.across.empty()) sum += mask.across[j] * new_point(walk_.next(h));
    }
    if (side.closed()) return sum;
    const HalfEdge last = walk_.previous(side.half_edges.back());
    add_edge(mask, static_cast<std::size_t>(side.triangles()), last, walk_.origin(last), sum);
    return sum;
  }

  /// After one more step, e_j is the new point of the edge and d_j is the old neighbour.
  template <typename Vertex>
  void add_edge(const TwoRingMask& mask, std::size_t j, const HalfEdge& half_edge, const Vertex& neighbour,
                Eigen::Vector3d& sum) const {
    if (mask.edges[j] != 0.0) sum += mask.edges[j] * new_point(half_edge);
    if (!mask.beyond.empty() && mask.beyond[j] != 0.0) sum += mask.beyond[j] * point_(neighbour);
  }

  /// Every edge at a corner is a curve that ends there. The normal is that of the cone of their tangents, its triangles
  /// weighted by area.
  Eigen::Vector3d cone_normal(const ButterflySide<Walk>& side) const {
    const double after = 2.0 * masks_.curve_end().after;
    const Eigen::Vector3d tip = point_(walk_.origin(side.half_edges.front()));
    const auto end_tangent = [&](const HalfEdge& h, const auto& neighbour) -> Eigen::Vector3d {
      return new_point(h) + after * point_(neighbour) - (1.0 + after) * tip;
    };
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const HalfEdge& h : side.half_edges) {
      const HalfEdge last = walk_.previous(h);
      sum += end_tangent(h, destination(h)).cross(end_tangent(last, walk_.origin(last)));
    }
    return sum;
  }

  const Walk& walk_;
  const ButterflyMasks& masks_;
  ButterflyRules<Walk> rules_;
  const Point& point_;
};

}  // namespace batten
