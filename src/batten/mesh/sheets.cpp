#include "batten/mesh/sheets.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>
#include <tuple>

namespace batten {

namespace {

constexpr Index kTurn = 1 << 16;

/// A face on the circle of angles. Faces that pass the edge backwards are placed half a turn further, so that a forward
/// and a backward face at the same place are flat continuations of each other.
struct Place {
  Index position;
  bool forward;
  Index side;
};

/// A candidate pair: two neighbours on the circle.
struct Candidate {
  Index bend;      ///< the deviation from flat, 0 to half a turn
  Index interior;  ///< the angle inside; below half a turn where the edge is convex
  std::size_t first;
  std::size_t second;
  bool operator>(const Candidate& other) const {
    return std::tie(bend, interior, first, second) > std::tie(other.bend, other.interior, other.first, other.second);
  }
};

/// Greedy matching on a circle: the closest two of opposite kind are always neighbours once matched ones are unlinked.
class Circle {
 public:
  explicit Circle(std::vector<Place> places) : places_(std::move(places)) {
    std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) {
      return std::tie(a.position, a.forward, a.side) < std::tie(b.position, b.forward, b.side);
    });
    const std::size_t n = places_.size();
    for (std::size_t i = 0; i < n; ++i) {
      next_.push_back((i + 1) % n);
      previous_.push_back((i + n - 1) % n);
    }
    taken_.assign(n, false);
  }

  void match(std::vector<std::pair<Index, Index>>& pairs) {
    for (std::size_t i = 0; i < places_.size(); ++i) propose(i, next_[i]);
    while (!candidates_.empty()) {
      const Candidate best = candidates_.top();
      candidates_.pop();
      if (taken_[best.first] || taken_[best.second]) continue;
      pairs.emplace_back(std::minmax(places_[best.first].side, places_[best.second].side));
      for (const std::size_t i : {best.first, best.second}) {
        taken_[i] = true;
        next_[previous_[i]] = next_[i];
        previous_[next_[i]] = previous_[i];
      }
      const std::size_t before = previous_[best.first];
      propose(before, next_[before]);
    }
  }

 private:
  void propose(std::size_t i, std::size_t j) {
    if (i == j || taken_[i] || taken_[j] || places_[i].forward == places_[j].forward) return;
    const Index gap = ((places_[j].position - places_[i].position) % kTurn + kTurn) % kTurn;
    const Place& forward = places_[i].forward ? places_[i] : places_[j];
    const Place& backward = places_[i].forward ? places_[j] : places_[i];
    const Index interior = ((forward.position - backward.position + kTurn / 2) % kTurn + kTurn) % kTurn;
    candidates_.push({std::min(gap, kTurn - gap), interior, i, j});
  }

  std::vector<Place> places_;
  std::vector<std::size_t> next_;
  std::vector<std::size_t> previous_;
  std::vector<bool> taken_;
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> candidates_;
};

}  // namespace

Index angle_around(const Eigen::Vector3d& axis, const EdgeFace& face) {
  const Eigen::Vector3d first = axis.unitOrthogonal();
  const Eigen::Vector3d second = axis.normalized().cross(first);
  // The face lies to the left of its side, so it extends from the edge in the direction normal x side.
  const Eigen::Vector3d along = face.listed_forward ? axis : Eigen::Vector3d(-axis);
  const Eigen::Vector3d away = face.normal.cross(along);
  const double turn = std::atan2(away.dot(second), away.dot(first)) / (2.0 * std::numbers::pi);
  return std::isfinite(turn) ? (static_cast<Index>(std::lround(turn * kTurn)) + kTurn) % kTurn : 0;
}

std::vector<std::pair<Index, Index>> match_sheets(const Eigen::Vector3d& axis, const std::vector<EdgeFace>& faces) {
  std::vector<std::pair<Index, Place>> places;  // by piece
  for (const EdgeFace& face : faces) {
    const Index angle = angle_around(axis, face);
    places.push_back({face.piece, {(angle + (face.forward ? 0 : kTurn / 2)) % kTurn, face.forward, face.side}});
  }
  std::stable_sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::pair<Index, Index>> pairs;
  for (std::size_t i = 0; i < places.size();) {
    std::vector<Place> piece;
    const Index name = places[i].first;
    for (; i < places.size() && places[i].first == name; ++i) piece.push_back(places[i].second);
    Circle(std::move(piece)).match(pairs);
  }
  std::vector<Index> matched;
  for (const auto& pair : pairs) matched.insert(matched.end(), {pair.first, pair.second});
  std::sort(matched.begin(), matched.end());
  std::vector<Place> rest;
  for (const auto& place : places) {
    if (!std::binary_search(matched.begin(), matched.end(), place.second.side)) rest.push_back(place.second);
  }
  Circle(std::move(rest)).match(pairs);
  return pairs;
}

}  // namespace batten
