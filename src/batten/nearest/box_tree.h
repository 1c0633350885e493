/// \file Leaning boxes in a tree of eight children a node, visited from the nearest on.
///
/// The tree is implicit: boxes stand in an order in which any eight in a row, any sixty-four, ... lie together, and a
/// level of nodes bounds eight of the level below. So the count of boxes says how the tree is made, and boxes that move
/// are written in place. All numbers are floats: distances are never too large, and hardly too small.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "batten/buffer.h"
#include "batten/nearest/lanes.h"
#include "batten/types.h"

namespace batten {

/// A box along the axes of space.
struct FloatBox {
  std::array<float, 3> low;
  std::array<float, 3> high;
};

/// A box along axes of its own, at right angles and of length 1 to the rounding of floats; the third is the product of
/// the two.
struct LeaningBox {
  std::array<float, 3> centre;
  std::array<float, 3> first;
  std::array<float, 3> second;
  std::array<float, 3> low;  ///< from the centre along each axis
  std::array<float, 3> high;
};

/// The boxes around a cell.
struct CellBox {
  LeaningBox leaning;
  FloatBox around;  ///< rounded to the nearest floats: BoxTree allows for that
};

/// Boxes around points whose fourth coordinate is 0. The leaning box has its first axis along `along`, its third along
/// the product of `along` and `across`; where these span no plane, its first axis runs along the longer.
CellBox cell_box_of(std::span<const Double4> points, const Double4& along, const Double4& across);

/// The middle of a box that a tree will have.
struct BoxMiddle {
  std::array<float, 3> at;
  Index box;  ///< its number
};
/// Brings middles into the order in which their boxes stand in a tree. O(n log n), threaded; it depends on the middles
/// and the numbers alone.
void sort_for_tree(Buffer<BoxMiddle>& middles);

/// The tree. It keeps no order of its own: the caller numbers the boxes as sort_for_tree() has them.
class BoxTree {
 public:
  static constexpr int kFanout = 8;

  BoxTree() = default;
  /// A tree of so many boxes, whose bounds are still to be set. 64 bytes a box.
  explicit BoxTree(Index box_count);

  Index box_count() const { return box_count_; }
  Index leaf_count() const { return static_cast<Index>(leaves_.size()); }

  /// Sets the boxes of a leaf, those at the places from kFanout * leaf on. Safe from several threads for different
  /// leaves.
  void set_leaf(Index leaf, std::span<const CellBox> boxes);
  /// Makes the bounds of all nodes once the leaves are set. O(n / 64), threaded.
  void bound_nodes();

  /// Around all boxes.
  const FloatBox& bounds() const { return bounds_; }

  /// Calls visit(place), which returns the limit from then on, for every box that is nearer to the point than the limit
  /// allows: nearest branches first. Limits are squared distances.
  template <typename Visit>
  void visit_near(const std::array<float, 3>& point, float limit, const Visit& visit) const;

 private:
  using Lanes = std::array<float, kFanout>;
  using Vectors = std::array<Lanes, 3>;
  struct Node {
    Vectors low;
    Vectors high;
  };
  struct Leaf {
    Vectors centre;
    Vectors first;
    Vectors second;
    Vectors low;
    Vectors high;
  };
  struct Entry {
    float distance;
    int level;  ///< of a node; 0 for a leaf, -1 for a box
    Index index;
  };
  static constexpr int kMostLevels = 11;  // eight to the eleventh: more than an Index counts

  FloatBox bounds_of(const Node& node) const;
  static void node_distances(const Node& node, const std::array<float, 3>& point, float margin, Lanes& distances);
  static void leaf_distances(const Leaf& leaf, const std::array<float, 3>& point, float margin, Lanes& distances);

  Index box_count_ = 0;
  Buffer<Leaf> leaves_;
  Buffer<Node> nodes_;                                ///< from the lowest level on; the last one is the root
  std::array<Index, kMostLevels + 2> level_start_{};  ///< level l has the nodes from level_start_[l] on
  int levels_ = 0;                                    ///< the leaves' included; 2 or more where there are boxes
  FloatBox bounds_{};
};

/// How far a number is outside an interval, less the margin, squared.
inline float squared_beyond(float low, float number, float high, float margin) {
  const float below = low - number;
  const float above = number - high;
  const float beyond = (below > above ? below : above) - margin;
  const float apart = beyond > 0.0F ? beyond : 0.0F;
  return apart * apart;
}

/// Squared distances of a point from the boxes of a node, less the margin, which takes up what rounding loses.
inline void BoxTree::node_distances(const Node& node, const std::array<float, 3>& point, float margin,
                                    Lanes& distances) {
  const float x = point[0];
  const float y = point[1];
  const float z = point[2];
  Lanes sums;
  for (int i = 0; i < kFanout; ++i) {
    sums[i] = squared_beyond(node.low[0][i], x, node.high[0][i], margin) +
              squared_beyond(node.low[1][i], y, node.high[1][i], margin) +
              squared_beyond(node.low[2][i], z, node.high[2][i], margin);
  }
  distances = sums;
}

inline void BoxTree::leaf_distances(const Leaf& leaf, const std::array<float, 3>& point, float margin,
                                    Lanes& distances) {
  const float px = point[0];
  const float py = point[1];
  const float pz = point[2];
  Lanes sums;
  for (int i = 0; i < kFanout; ++i) {
    const float x = px - leaf.centre[0][i];
    const float y = py - leaf.centre[1][i];
    const float z = pz - leaf.centre[2][i];
    const float a0 = leaf.first[0][i];
    const float a1 = leaf.first[1][i];
    const float a2 = leaf.first[2][i];
    const float b0 = leaf.second[0][i];
    const float b1 = leaf.second[1][i];
    const float b2 = leaf.second[2][i];
    const float along = a0 * x + a1 * y + a2 * z;
    const float across = b0 * x + b1 * y + b2 * z;
    const float up = (a1 * b2 - a2 * b1) * x + (a2 * b0 - a0 * b2) * y + (a0 * b1 - a1 * b0) * z;
    sums[i] = squared_beyond(leaf.low[0][i], along, leaf.high[0][i], margin) +
              squared_beyond(leaf.low[1][i], across, leaf.high[1][i], margin) +
              squared_beyond(leaf.low[2][i], up, leaf.high[2][i], margin);
  }
  distances = sums;
}

template <typename Visit>
void BoxTree::visit_near(const std::array<float, 3>& point, float limit, const Visit& visit) const {
  if (levels_ == 0) return;
  constexpr float kRounding = 16.0F * std::numeric_limits<float>::epsilon();
  constexpr float kLess = 1.0F - 16.0F * std::numeric_limits<float>::epsilon();
  float size = 0.0F;
  for (int c = 0; c < 3; ++c)
    size = std::max({size, std::abs(point[c]), std::abs(bounds_.low[c]), std::abs(bounds_.high[c])});
  const float margin = kRounding * size;
  std::array<Entry, kFanout*(kMostLevels + 2)> stack;
  int count = 0;
  stack[count++] = {0.0F, levels_ - 1, 0};
  Lanes distances;
  while (count > 0) {
    const Entry entry = stack[--count];
    if (!(entry.distance < limit)) continue;
    if (entry.level < 0) {
      limit = visit(entry.index);
      continue;
    }
    if (entry.level == 0) {
      leaf_distances(leaves_[entry.index], point, margin, distances);
    } else {
      node_distances(nodes_[level_start_[entry.level] + entry.index], point, margin, distances);
    }
    const int first = count;
    for (int i = 0; i < kFanout; ++i) {
      stack[count] = {distances[i] * kLess, entry.level - 1, entry.index * kFanout + i};
      count += stack[count].distance < limit ? 1 : 0;
    }
    if (entry.level == 1) {
      for (int i = first; i < count; ++i) {
        const char* leaf = reinterpret_cast<const char*>(&leaves_[stack[i].index]);
        for (std::size_t byte = 0; byte < sizeof(Leaf); byte += 64) __builtin_prefetch(leaf + byte);
      }
    }
    for (int i = first + 1; i < count; ++i) {
      const Entry moved = stack[i];
      int place = i;
      for (; place > first && stack[place - 1].distance < moved.distance; --place) stack[place] = stack[place - 1];
      stack[place] = moved;
    }
  }
}

}  // namespace batten
