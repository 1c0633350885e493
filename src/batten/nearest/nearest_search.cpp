#include "batten/nearest/nearest_search.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "batten/nearest/squared_distance.h"

namespace batten {

namespace {

/// A query that has visited so many parts of cells is near a part of the surface that degenerates. It returns the best
/// point so far, and the least distance that is proved by then.
constexpr int kMostVisits = 20000;
/// Around a pole all its faces may be equally near, each with four parts at every level until they are within the
/// tolerance of the pole: after some fifty halvings.
constexpr int kMostVisitsAPoleFace = 256;
/// Where the squared distance is less convex than this, Newton's method proves nothing in reasonable time.
constexpr double kLeastModulus = 0.02;
/// Newton's method takes no more steps in a cell.
constexpr int kMostCellSteps = 12;

}  // namespace

template <typename Net>
NearestSearch<Net>::NearestSearch(const SurfaceCells<Net>& cells)
    : cells_(cells),
      most_visits_(kMostVisits + std::int64_t{kMostVisitsAPoleFace} * cells.most_pole_faces()),
      scratch_(cells.most_points()) {}

template <typename Net>
NearestFound NearestSearch<Net>::find(const Double4& query, double tolerance, bool any_point) {
  query_ = query;
  tolerance_ = tolerance;
  best_ = {};
  best_.squared = best_.least = cut_ = std::numeric_limits<double>::infinity();
  visits_ = 0;
  const Double4 from_centre = (query - cells_.centre()) * cells_.scale();
  const std::array<float, 3> point{static_cast<float>(from_centre[0]), static_cast<float>(from_centre[1]),
                                   static_cast<float>(from_centre[2])};
  constexpr float kMore = 1.0F + 4.0F * std::numeric_limits<float>::epsilon();
  pending_.clear();
  queue_.clear();
  cells_.tree().visit_near(point, std::numeric_limits<float>::infinity(), [&](Index place) {
    if (cut_ > 0.0) visit(place);
    if (any_point && std::isfinite(best_.squared)) cut_ = 0.0;
    return cut_ > 0.0 ? static_cast<float>(best_.squared * cells_.scale() * cells_.scale()) * kMore : 0.0F;
  });
  search_pending();
  best_.least = cut_ > 0.0 ? std::min(best_.least, best_.squared) : 0.0;
  return best_;
}

/// True where a part whose squared distance is at least this can be left; then the proof takes note of the bound.
template <typename Net>
bool NearestSearch<Net>::leave(double squared) {
  if (squared < cut_ && visits_ < most_visits_) return false;
  best_.least = std::min(best_.least, squared);
  return true;
}

template <typename Net>
bool NearestSearch<Net>::leave_box(const Double4* points, std::size_t count) {
  Double4 low = points[0];
  Double4 high = points[0];
  for (std::size_t i = 1; i < count; ++i) {
    low = lower(low, points[i]);
    high = higher(high, points[i]);
  }
  return leave(squared_distance_of_box(low, high));
}

template <typename Net>
bool NearestSearch<Net>::offer(const Double4& point, double u, double v) {
  const double squared = dot(point, point);
  if (!(squared < best_.squared)) return false;
  best_.squared = squared;
  best_.offset = point;
  best_.face = face_;
  best_.u = u;
  best_.v = v;
  const double interesting = std::sqrt(squared) - tolerance_;
  cut_ = interesting > 0.0 ? interesting * interesting : 0.0;
  return true;
}

template <typename Net>
void NearestSearch<Net>::visit(Index place) {
  const auto& cell = cells_.cell(place);
  const CellShape& shape = cells_.shape(cell);
  face_ = cells_.face(cell);
  rings_.resize(std::max<std::size_t>(static_cast<std::size_t>(shape.rows), Net::kPoints));
  cells_.points(cell, query_, scratch_, rings_.data());
  const Placement placement = cells_.placement(cell);
  if (shape.type == RingTypes::kPatch) {
    search_net(rings_.data(), placement);
    return;
  }
  rings_.resize(static_cast<std::size_t>(shape.rows));
  offer_corners(placement);
  search_ring(shape.type, 0, placement);
}

/// A part that one attempt does not settle waits until all cells of the tree have been visited: by then a nearer point
/// may be known.
template <typename Net>
void NearestSearch<Net>::search_net(const Double4* net, const Placement& placement) {
  ++visits_;
  const NetFrame<Net> frame(net);
  double least = frame.least_squared();
  if (leave(least) || descend(net, frame, frame.convexity(), placement, least)) return;
  if (search_border(net, placement)) return;
  queue_.emplace_back(least, pending_.size());
  std::push_heap(queue_.begin(), queue_.end(), std::greater<>());
  pending_.push_back({face_, placement, {}});
  std::copy_n(net, Net::kPoints, pending_.back().net.begin());
}

/// Halves the waiting parts, the nearest first.
template <typename Net>
void NearestSearch<Net>::search_pending() {
  while (!queue_.empty()) {
    std::pop_heap(queue_.begin(), queue_.end(), std::greater<>());
    const auto [least, place] = queue_.back();
    queue_.pop_back();
    if (leave(least)) continue;  // no other part is nearer, so they are all left
    const Part part = pending_[place];
    face_ = part.face;
    for (int child = 0; child < 4; ++child) {
      std::array<Double4, Net::kPoints> half_net;
      half_matrix<Net>(child).apply(part.net.data(), half_net.data());
      search_net(half_net.data(), part.placement.of(half<Net>(child)));
    }
  }
}

/// True where the squared distance falls all over the cell towards one of its sides, and has a single minimum along
/// that side, which is offered. This settles queries beyond creases and boundaries.
template <typename Net>
bool NearestSearch<Net>::search_border(const Double4* net, const Placement& placement) {
  const std::array<bool, Net::kCorners> falls_to = falling_sides<Net>(net);
  for (int side = 0; side < Net::kCorners; ++side) {
    if (!falls_to[side]) continue;
    double t = 0.0;
    if (!find_least_on_side<Net>(net, side, t)) continue;
    const int next = (side + 1) % Net::kCorners;
    const double u = (1.0 - t) * Net::kCornerU[side] + t * Net::kCornerU[next];
    const double v = (1.0 - t) * Net::kCornerV[side] + t * Net::kCornerV[next];
    const Double4 point = Net::jet(net, u, v).point;
    offer(point, placement.u(u), placement.v(v));
    return true;
  }
  return false;
}

/// Follows Newton's method in the cell. True where it proves that no point of the cell is nearer than those it offered
/// by more than the tolerance.
template <typename Net>
bool NearestSearch<Net>::descend(const Double4* net, const NetFrame<Net>& frame, double modulus,
                                 const Placement& placement, double& least) {
  constexpr double kSmallStep = 1e-7;  // after such a step the error is about its square
  const bool provable = modulus > kLeastModulus;
  double u = Net::kMiddle;  // bounds reach farthest from the middle
  double v = Net::kMiddle;
  if (provable) frame.guess(u, v);
  bool best_here = false;
  double step = 1.0;
  for (int i = 0; i < (provable ? kMostCellSteps : 3); ++i) {
    const NetJet jet = Net::jet(net, u, v);
    best_here = offer(jet.point, placement.u(u), placement.v(v)) || best_here;
    DistanceModel model(jet);
    if (frame.flat_enough) {
      least = std::max(least, dot(jet.point, jet.point) - 2.0 * most_decrease(model, frame, modulus, u, v));
      const bool proved = !(least < cut_);
      if (proved && (!best_here || step < kSmallStep)) {
        best_.least = std::min(best_.least, least);
        return true;
      }
    }
    if (!model.is_convex()) model.flatten(jet);
    if (!model.is_convex()) return false;
    const double old_u = u;
    const double old_v = v;
    move_to_least<Net>(model, u, v);
    step = std::abs(u - old_u) + std::abs(v - old_v);
  }
  return false;
}

/// Offers the corners of a ring's face that are vertices of the base, whose limit positions are known.
template <typename Net>
void NearestSearch<Net>::offer_corners(const Placement& placement) {
  for (int c = 0; c < Net::kCorners; ++c) {
    const double u = placement.u(Net::kCornerU[c]);
    const double v = placement.v(Net::kCornerV[c]);
    for (int corner = 0; corner < Net::kCorners; ++corner) {
      if (u != Net::kCornerU[corner] || v != Net::kCornerV[corner]) continue;
      const Topology& base = cells_.base();
      offer(cells_.limit_position(base.origin(base.face_begin(face_) + corner)) - query_, u, v);
    }
  }
}

/// The ring's points stand on the stack from `first` on, the face's own before the others.
template <typename Net>
void NearestSearch<Net>::search_ring(Index type, std::size_t first, const Placement& placement) {
  ++visits_;
  if (leave_box(&rings_[first], rings_.size() - first)) return;
  std::array<std::pair<double, int>, 4> order;
  Double4 middle{};
  for (int c = 0; c < Net::kCorners; ++c) {
    const Double4& corner = rings_[first + static_cast<std::size_t>(c)];
    order[c] = {dot(corner, corner), c};
    middle += corner / static_cast<double>(Net::kCorners);
  }
  if (Net::kCorners == 3) order[3] = {dot(middle, middle), 3};
  std::sort(order.begin(), order.end());
  for (const auto& each : order) {
    search_ring_child(cells_.ring_types().child(type, each.second), first, placement.of(half<Net>(each.second)));
  }
}

template <typename Net>
void NearestSearch<Net>::search_ring_child(const RingTypes::Child& child, std::size_t first,
                                           const Placement& placement) {
  const std::size_t own = rings_.size();
  rings_.resize(own + static_cast<std::size_t>(child.rows.count()));
  ring_child_points<Net>(child, &rings_[first], &rings_[own]);
  if (child.type == RingTypes::kPatch) {
    std::array<Double4, Net::kPoints> net;
    spline_matrix<Net>().apply(&rings_[own], net.data());
    search_net(net.data(), placement);
  } else {
    search_ring(child.type, own, placement);
  }
  rings_.resize(own);
}

template class NearestSearch<QuadNet>;
template class NearestSearch<TriangleNet>;

}  // namespace batten
