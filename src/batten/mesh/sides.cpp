#include "batten/mesh/sides.h"

#include <algorithm>
#include <deque>
#include <numeric>

namespace batten {

DisjointSets::DisjointSets(std::size_t count) : parents_(count) { std::iota(parents_.begin(), parents_.end(), 0); }

Index DisjointSets::root(Index i) {
  while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
  return i;
}

void DisjointSets::join(Index a, Index b) {
  a = root(a);
  b = root(b);
  parents_[std::max(a, b)] = std::min(a, b);
}

SideTable::SideTable(const Buffer<Index>& offsets, const Buffer<Index>& vertices, const Buffer<std::uint8_t>& skipped)
    : offsets_(offsets), vertices_(vertices), faces_(vertices.size()) {
  const auto for_each_side = [&](const auto& visit) {
    for (Index f = 0; f < face_count(); ++f) {
      if (!skipped.empty() && skipped[f] != 0) continue;
      for (Index c = offsets[f]; c < offsets[f + 1]; ++c) visit(c, std::min(from(c), to(c)));
    }
  };
  for (Index f = 0; f < face_count(); ++f) std::fill(faces_.begin() + offsets[f], faces_.begin() + offsets[f + 1], f);
  // Sides are counted into buckets by lower vertex and then sorted within each bucket.
  Index highest = -1;
  for_each_side([&](Index /*c*/, Index low) { highest = std::max(highest, low); });
  Buffer<Index> ends(static_cast<std::size_t>(highest) + 2, 0);
  for_each_side([&](Index /*c*/, Index low) { ++ends[low + 1]; });
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  sides_.resize(static_cast<std::size_t>(ends.back()));
  for_each_side([&](Index c, Index low) { sides_[ends[low]++] = {edge_key(from(c), to(c)), c}; });
  Index begin = 0;
  for (const Index end : ends) {
    std::sort(sides_.begin() + begin, sides_.begin() + end);
    begin = end;
  }
}

SidePairs::SidePairs(Index corner_count)
    : partner(static_cast<std::size_t>(corner_count), -1), same_way(static_cast<std::size_t>(corner_count), 0) {}

void SidePairs::join(Index a, Index b, bool same) {
  partner[a] = b;
  partner[b] = a;
  same_way[a] = same_way[b] = same ? 1 : 0;
}

void SidePairs::part(Index side) {
  if (partner[side] >= 0) partner[partner[side]] = -1;
  partner[side] = -1;
}

SidePairs pair_sides(const SideTable& sides) {
  SidePairs pairs(sides.corner_count());
  sides.for_each_edge([&](const SideTable::Side* first, const SideTable::Side* last) {
    if (last - first != 2) return;
    pairs.join(first[0].corner, first[1].corner, sides.from(first[0].corner) == sides.from(first[1].corner));
  });
  return pairs;
}

namespace {

/// Visits the faces of one component, those that agree first. The order in which the others are visited decides which
/// pairs remain in conflict.
class Walk {
 public:
  Walk(const SideTable& sides, const SidePairs& pairs, Orientation& result)
      : sides_(sides), pairs_(pairs), result_(result), met_(result.component.size(), 0) {}

  void from(Index seed) {
    queue_.push_back({-1, seed});
    members_.clear();
    std::ptrdiff_t reversed = 0;
    while (!queue_.empty()) {
      const Step step = queue_.front();
      queue_.pop_front();
      if (met_[step.face] != 0) continue;
      met_[step.face] = 1;
      result_.component[step.face] = result_.component_count;
      result_.reversed[step.face] = step.side < 0 ? 0 : wanted(step.side);
      reversed += result_.reversed[step.face];
      members_.push_back(step.face);
      spread(step.face);
    }
    ++result_.component_count;
    if (2 * reversed <= static_cast<std::ptrdiff_t>(members_.size())) return;
    for (const Index f : members_) result_.reversed[f] ^= 1;
  }

 private:
  struct Step {
    Index side;  ///< the side of the previous face that led here, or -1
    Index face;
  };

  std::uint8_t wanted(Index side) const { return result_.reversed[sides_.face(side)] ^ pairs_.same_way[side]; }

  void spread(Index face) {
    for (Index side = sides_.offsets()[face]; side < sides_.offsets()[face + 1]; ++side) {
      const Index partner = pairs_.partner[side];
      if (partner < 0) continue;
      const Index other = sides_.face(partner);
      if (met_[other] != 0) {
        if (result_.reversed[other] != wanted(side)) result_.conflicts.push_back(side);
      } else if (pairs_.same_way[side] == 0) {
        queue_.push_front({side, other});
      } else {
        queue_.push_back({side, other});
      }
    }
  }

  const SideTable& sides_;
  const SidePairs& pairs_;
  Orientation& result_;
  Buffer<std::uint8_t> met_;
  std::deque<Step> queue_;
  Buffer<Index> members_;
};

}  // namespace

Orientation orient(const SideTable& sides, const SidePairs& pairs) {
  const auto face_count = static_cast<std::size_t>(sides.face_count());
  Orientation result;
  result.reversed.assign(face_count, 0);
  result.component.assign(face_count, -1);
  Walk walk(sides, pairs, result);
  for (Index f = 0; f < sides.face_count(); ++f) {
    if (result.component[f] < 0) walk.from(f);
  }
  return result;
}

}  // namespace batten
