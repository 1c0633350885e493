#include "batten/fit/far_groups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace batten {

namespace {

constexpr Index kGroupBoxes = 24;
constexpr Index kBoxCount = kGroupBoxes * kGroupBoxes * kGroupBoxes;

/// Boxes with points that touch each other, by number; -1 for empty ones.
std::vector<Index> joined_boxes(const std::vector<std::uint8_t>& filled, Index& count) {
  std::vector<Index> group(filled.size(), -1);
  std::vector<Index> waiting;
  count = 0;
  for (Index start = 0; start < kBoxCount; ++start) {
    if (filled[start] == 0 || group[start] >= 0) continue;
    group[start] = count;
    waiting.push_back(start);
    while (!waiting.empty()) {
      const Index box = waiting.back();
      waiting.pop_back();
      const std::array<Index, 3> at{box % kGroupBoxes, box / kGroupBoxes % kGroupBoxes,
                                    box / (kGroupBoxes * kGroupBoxes)};
      for (int step = 0; step < 27; ++step) {
        const std::array<Index, 3> to{at[0] + step % 3 - 1, at[1] + step / 3 % 3 - 1, at[2] + step / 9 - 1};
        if (std::any_of(to.begin(), to.end(), [](Index t) { return t < 0 || t >= kGroupBoxes; })) continue;
        const Index other = to[0] + kGroupBoxes * (to[1] + kGroupBoxes * to[2]);
        if (filled[other] == 0 || group[other] >= 0) continue;
        group[other] = count;
        waiting.push_back(other);
      }
    }
    ++count;
  }
  return group;
}

/// The box of each of some points in the cube around them.
std::vector<Index> boxes_of(const Points& points, const Buffer<Index>& rows) {
  Eigen::RowVector3d low = points.row(rows[0]);
  Eigen::RowVector3d high = low;
  for (const Index row : rows) {
    low = low.cwiseMin(points.row(row));
    high = high.cwiseMax(points.row(row));
  }
  const double size = (high - low).maxCoeff();
  std::vector<Index> boxes(rows.size(), 0);
  if (!(size > 0.0)) return boxes;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Index box = 0;
    for (Eigen::Index c = 2; c >= 0; --c) {
      const double share = (points(rows[i], c) - low(c)) / size;
      box = box * kGroupBoxes + std::min(kGroupBoxes - 1, static_cast<Index>(share * kGroupBoxes));
    }
    boxes[i] = box;
  }
  return boxes;
}

/// The groups of some points, one where they fill the box well.
std::vector<Buffer<Index>> groups_of(const Points& points, const Buffer<Index>& rows) {
  constexpr Index kFewBoxes = 6;  // along an axis: a quarter of the box
  const std::vector<Index> boxes = boxes_of(points, rows);
  std::vector<std::uint8_t> filled(static_cast<std::size_t>(kBoxCount), 0);
  for (const Index box : boxes) filled[box] = 1;
  Index count = 0;
  const std::vector<Index> group = joined_boxes(filled, count);
  if (count < 2) return {rows};
  for (Index g = 0; g < count; ++g) {
    for (Index axis = 0, step = 1; axis < 3; ++axis, step *= kGroupBoxes) {
      Index low = kGroupBoxes;
      Index high = -1;
      for (Index box = 0; box < kBoxCount; ++box) {
        if (group[box] != g) continue;
        low = std::min(low, box / step % kGroupBoxes);
        high = std::max(high, box / step % kGroupBoxes);
      }
      if (high - low >= kFewBoxes) return {rows};
    }
  }
  std::vector<Buffer<Index>> groups(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < rows.size(); ++i) groups[group[boxes[i]]].push_back(rows[i]);
  return groups;
}

}  // namespace

std::vector<Buffer<Index>> far_groups(const Points& points, Index fewest) {
  Buffer<Index> all(static_cast<std::size_t>(points.rows()));
  std::iota(all.begin(), all.end(), 0);
  if (all.empty()) return {all};
  std::vector<Buffer<Index>> waiting{all};
  std::vector<Buffer<Index>> done;
  while (!waiting.empty()) {
    Buffer<Index> rows = std::move(waiting.back());
    waiting.pop_back();
    std::vector<Buffer<Index>> parts = groups_of(points, rows);
    if (parts.size() == 1) {
      done.push_back(std::move(parts[0]));
      continue;
    }
    // Lonely points are no reason to take the others apart.
    for (auto part = parts.rbegin(); part != parts.rend(); ++part) {
      if (static_cast<Index>(part->size()) >= fewest) waiting.push_back(std::move(*part));
    }
    if (waiting.empty() && done.empty()) return {all};
  }
  return done;
}

}  // namespace batten
