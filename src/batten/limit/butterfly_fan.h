/// \file Limit normals of the Butterflies on one side of a vertex, of any connectivity that their rules walk over
/// (refine/butterfly_rules.h).
#pragma once
#include <Eigen/Geometry>

#include "batten/limit/butterfly_tangents.h"

namespace batten {

/// Outgoing half-edges of a vertex, counter-clockwise: of all its triangles where it is smooth, those of a dart from
/// its sharp edge on, else those of the side between two sharp edges.
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
  /// Corners are cones; two triangles that share two edges have no tangent plane.
  bool has_masks() const { return kind != ButterflyVertex::Corner && !(closed() && triangles() < 3); }
};

/// The side of h's origin that has h.
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

/// The unit normal, zero where there is none. point(vertex): the position of a vertex of the walk.
template <typename Walk, typename Point>
class ButterflyNormal {
 public:
  ButterflyNormal(const Walk& walk, const ButterflyMasks& masks, const Point& point)
      : walk_(walk), masks_(masks), rules_(walk, masks), point_(point) {}

  /// tangents: of the side's shape, or null where it has no masks.
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
  /// The sine below which two tangents are one: where Butterfly is not smooth both masks are its first eigenvector.
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

  /// One step on, e_j is the new point of the edge and d_j the neighbour that e_j was.
  template <typename Vertex>
  void add_edge(const TwoRingMask& mask, std::size_t j, const HalfEdge& half_edge, const Vertex& neighbour,
                Eigen::Vector3d& sum) const {
    if (mask.edges[j] != 0.0) sum += mask.edges[j] * new_point(half_edge);
    if (!mask.beyond.empty() && mask.beyond[j] != 0.0) sum += mask.beyond[j] * point_(neighbour);
  }

  /// Every edge at a corner is a curve that ends there: the cone of their tangents, its triangles weighted by area.
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
