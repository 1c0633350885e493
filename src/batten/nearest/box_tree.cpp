#include "batten/nearest/box_tree.h"

#include "batten/parallel/parallel.h"

namespace batten {

namespace {

constexpr float kNowhere = std::numeric_limits<float>::infinity();
constexpr FloatBox kEmpty{{kNowhere, kNowhere, kNowhere}, {-kNowhere, -kNowhere, -kNowhere}};

void include(const FloatBox& box, FloatBox& all) {
  for (int c = 0; c < 3; ++c) {
    all.low[c] = std::min(all.low[c], box.low[c]);
    all.high[c] = std::max(all.high[c], box.high[c]);
  }
}

/// Halves [begin, end) by the longest axis of its middles until a leaf holds it; `capacity` is the power of two that
/// the range is an aligned part of.
void sort_range(BoxMiddle* begin, BoxMiddle* end, std::ptrdiff_t capacity) {
  constexpr std::ptrdiff_t kAlone = 1 << 14;
  const std::ptrdiff_t half = capacity / 2;
  if (capacity <= BoxTree::kFanout) return;
  if (end - begin > half) {
    FloatBox all = kEmpty;
    for (const BoxMiddle* i = begin; i != end; ++i) include({i->at, i->at}, all);
    int axis = 0;
    for (int c = 1; c < 3; ++c) {
      if (all.high[c] - all.low[c] > all.high[axis] - all.low[axis]) axis = c;
    }
    std::nth_element(begin, begin + half, end, [axis](const BoxMiddle& a, const BoxMiddle& b) {
      return a.at[axis] != b.at[axis] ? a.at[axis] < b.at[axis] : a.box < b.box;
    });
  }
  BoxMiddle* split = std::min(begin + half, end);
  const auto first = [&] { sort_range(begin, split, half); };
  const auto second = [&] { sort_range(split, end, half); };
  if (end - begin > kAlone) {
    parallel_both(first, second);
  } else {
    first();
    if (split != end) second();
  }
}

/// Floats that are no more, and no less, than a number: its relative change exceeds what rounding to a float does.
float float_below(double number) {
  return static_cast<float>(number - std::abs(number) * std::numeric_limits<float>::epsilon());
}
float float_above(double number) {
  return static_cast<float>(number + std::abs(number) * std::numeric_limits<float>::epsilon());
}

/// The axes of a leaning box, as floats.
struct Axes {
  Double4 first;
  Double4 second;
};
Axes rounded(const Double4& first, const Double4& second) {
  Axes axes{};
  for (int c = 0; c < 3; ++c) {
    axes.first[c] = static_cast<float>(first[c]);
    axes.second[c] = static_cast<float>(second[c]);
  }
  return axes;
}

/// A unit vector at a right angle to another.
Double4 unit_across(const Double4& unit) {
  const Double4 other = std::abs(unit[0]) < 0.6 ? Double4{1.0, 0.0, 0.0, 0.0} : Double4{0.0, 1.0, 0.0, 0.0};
  const Double4 normal = cross(unit, other);
  return normal / std::sqrt(dot(normal, normal));
}

Axes axes_of(const Double4& along, const Double4& across) {
  constexpr double kLeastAngle = 1e-6;
  const double along_squared = dot(along, along);
  const double across_squared = dot(across, across);
  const Double4 normal = cross(along, across);
  const double area_squared = dot(normal, normal);
  if (area_squared > kLeastAngle * kLeastAngle * along_squared * across_squared) {
    const Double4 first = along / std::sqrt(along_squared);
    return rounded(first, cross(normal / std::sqrt(area_squared), first));
  }
  const Double4& longer = along_squared >= across_squared ? along : across;
  const double length = std::sqrt(dot(longer, longer));
  const Double4 first = length > 0.0 ? longer / length : Double4{1.0, 0.0, 0.0, 0.0};
  return rounded(first, unit_across(first));
}

}  // namespace

CellBox cell_box_of(std::span<const Double4> points, const Double4& along, const Double4& across) {
  Double4 mean{};
  for (const Double4& point : points) mean += point;
  mean /= static_cast<double>(points.size());
  // Lengths are measured from the centre and along the axes as they are in floats.
  const Axes axes = axes_of(along, across);
  const Double4 third = cross(axes.first, axes.second);
  CellBox box;
  for (int c = 0; c < 3; ++c) {
    box.leaning.centre[c] = static_cast<float>(mean[c]);
    mean[c] = box.leaning.centre[c];
    box.leaning.first[c] = static_cast<float>(axes.first[c]);
    box.leaning.second[c] = static_cast<float>(axes.second[c]);
  }
  const Double4 x{axes.first[0], axes.second[0], third[0], 0.0};
  const Double4 y{axes.first[1], axes.second[1], third[1], 0.0};
  const Double4 z{axes.first[2], axes.second[2], third[2], 0.0};
  const auto seen = [&](const Double4& point) { return point[0] * x + point[1] * y + point[2] * z; };
  Double4 low = points[0];
  Double4 high = points[0];
  Double4 leaning_low = seen(points[0]);
  Double4 leaning_high = leaning_low;
  for (const Double4& point : points) {
    const Double4 at = seen(point);
    low = lower(low, point);
    high = higher(high, point);
    leaning_low = lower(leaning_low, at);
    leaning_high = higher(leaning_high, at);
  }
  leaning_low -= seen(mean);
  leaning_high -= seen(mean);
  for (int c = 0; c < 3; ++c) {
    box.around.low[c] = static_cast<float>(low[c]);
    box.around.high[c] = static_cast<float>(high[c]);
    box.leaning.low[c] = float_below(leaning_low[c]);
    box.leaning.high[c] = float_above(leaning_high[c]);
  }
  return box;
}

void sort_for_tree(Buffer<BoxMiddle>& middles) {
  std::ptrdiff_t capacity = 1;
  while (capacity < static_cast<std::ptrdiff_t>(middles.size())) capacity *= 2;
  sort_range(middles.data(), middles.data() + middles.size(), capacity);
}

BoxTree::BoxTree(Index box_count) : box_count_(box_count) {
  if (box_count == 0) return;
  Index count = (box_count - 1) / kFanout + 1;
  leaves_.resize(static_cast<std::size_t>(count));
  levels_ = 1;
  Index nodes = 0;
  do {
    count = (count - 1) / kFanout + 1;
    level_start_[levels_++] = nodes;
    nodes += count;
  } while (count > 1);
  level_start_[levels_] = nodes;
  Node empty;
  for (int c = 0; c < 3; ++c) {
    empty.low[c].fill(kNowhere);
    empty.high[c].fill(-kNowhere);
  }
  nodes_.assign(static_cast<std::size_t>(nodes), empty);
}

void BoxTree::set_leaf(Index leaf, std::span<const CellBox> boxes) {
  LeaningBox none{};
  none.low = kEmpty.low;
  Leaf& to = leaves_[leaf];
  FloatBox all = kEmpty;
  for (std::size_t i = 0; i < kFanout; ++i) {
    const LeaningBox& box = i < boxes.size() ? boxes[i].leaning : none;
    if (i < boxes.size()) include(boxes[i].around, all);
    for (int c = 0; c < 3; ++c) {
      to.centre[c][i] = box.centre[c];
      to.first[c][i] = box.first[c];
      to.second[c][i] = box.second[c];
      to.low[c][i] = box.low[c];
      to.high[c][i] = box.high[c];
    }
  }
  Node& parent = nodes_[leaf / kFanout];
  for (int c = 0; c < 3; ++c) {
    parent.low[c][leaf % kFanout] = all.low[c];
    parent.high[c][leaf % kFanout] = all.high[c];
  }
}

FloatBox BoxTree::bounds_of(const Node& node) const {
  FloatBox all = kEmpty;
  for (int i = 0; i < kFanout; ++i) {
    include({{node.low[0][i], node.low[1][i], node.low[2][i]}, {node.high[0][i], node.high[1][i], node.high[2][i]}},
            all);
  }
  return all;
}

void BoxTree::bound_nodes() {
  if (levels_ == 0) return;
  for (int level = 2; level < levels_; ++level) {
    const Node* below = &nodes_[level_start_[level - 1]];
    const Index count_below = level_start_[level] - level_start_[level - 1];
    Node* nodes = &nodes_[level_start_[level]];
    parallel_for(level_start_[level + 1] - level_start_[level], [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t child = kFanout * begin; child < std::min<std::ptrdiff_t>(kFanout * end, count_below);
           ++child) {
        const FloatBox all = bounds_of(below[child]);
        Node& node = nodes[child / kFanout];
        for (int c = 0; c < 3; ++c) {
          node.low[c][child % kFanout] = all.low[c];
          node.high[c][child % kFanout] = all.high[c];
        }
      }
    });
  }
  bounds_ = bounds_of(nodes_.back());
}

}  // namespace batten
