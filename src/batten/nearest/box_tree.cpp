#include "batten/nearest/box_tree.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <numeric>

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

/// Twice the box's centre.
float middle(const FloatBox& box, int axis) { return box.low[axis] + box.high[axis]; }

/// Halves [begin, end) by the longest axis of its centres until a leaf holds it; `capacity` is the power of two that
/// the range is an aligned part of.
void sort_for_tree(const Buffer<FloatBox>& boxes, Index* begin, Index* end, std::ptrdiff_t capacity) {
  constexpr std::ptrdiff_t kAlone = 1 << 14;
  const std::ptrdiff_t half = capacity / 2;
  if (capacity <= BoxTree::kFanout) return;
  if (end - begin > half) {
    FloatBox centres = kEmpty;
    for (const Index* i = begin; i != end; ++i) {
      const std::array<float, 3> centre{middle(boxes[*i], 0), middle(boxes[*i], 1), middle(boxes[*i], 2)};
      include({centre, centre}, centres);
    }
    int axis = 0;
    for (int c = 1; c < 3; ++c) {
      if (centres.high[c] - centres.low[c] > centres.high[axis] - centres.low[axis]) axis = c;
    }
    std::nth_element(begin, begin + half, end, [&](Index a, Index b) {
      const float x = middle(boxes[a], axis);
      const float y = middle(boxes[b], axis);
      return x != y ? x < y : a < b;
    });
  }
  Index* split = std::min(begin + half, end);
  const auto first = [&] { sort_for_tree(boxes, begin, split, half); };
  const auto second = [&] { sort_for_tree(boxes, split, end, half); };
  if (end - begin > kAlone) {
    parallel_both(first, second);
  } else {
    first();
    if (split != end) second();
  }
}

}  // namespace

LeaningBox leaning_box_of(const Eigen::Vector4d* points, std::size_t count, const Eigen::Vector3d& along) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < count; ++i) mean += points[i].head<3>();
  mean /= static_cast<double>(count);
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d away = points[i].head<3>() - mean;
    moments += away * away.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(moments);
  const Eigen::Vector3d normal = solver.eigenvectors().col(0).normalized();
  const Eigen::Vector3d seen = along - along.dot(normal) * normal;
  const Eigen::Vector3d axis = seen.norm() > 1e-3 * along.norm() ? seen.normalized() : normal.unitOrthogonal();
  LeaningBox box;
  Eigen::Map<Eigen::Vector3f>(box.centre.data()) = mean.cast<float>();
  Eigen::Map<Eigen::Vector3f>(box.first.data()) = axis.cast<float>();
  Eigen::Map<Eigen::Vector3f>(box.second.data()) = normal.cross(axis).cast<float>();
  // Measured along the axes as they are in floats.
  Eigen::Matrix3d axes;
  for (int c = 0; c < 3; ++c) {
    mean[c] = box.centre[c];
    axes(0, c) = box.first[c];
    axes(1, c) = box.second[c];
  }
  axes.row(2) = axes.row(0).cross(axes.row(1));
  Eigen::Vector3d low = axes * (points[0].head<3>() - mean);
  Eigen::Vector3d high = low;
  for (std::size_t i = 1; i < count; ++i) {
    const Eigen::Vector3d at = axes * (points[i].head<3>() - mean);
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  for (int c = 0; c < 3; ++c) {
    box.low[c] = std::nextafter(static_cast<float>(low[c]), -kNowhere);
    box.high[c] = std::nextafter(static_cast<float>(high[c]), kNowhere);
  }
  return box;
}

BoxTree::BoxTree(const Buffer<LeaningBox>& boxes, const Buffer<FloatBox>& around, Buffer<Index>& order) {
  order.resize(boxes.size());
  std::iota(order.begin(), order.end(), 0);
  if (boxes.empty()) return;
  std::ptrdiff_t capacity = 1;
  while (capacity < static_cast<std::ptrdiff_t>(boxes.size())) capacity *= 2;
  sort_for_tree(around, order.data(), order.data() + order.size(), capacity);
  fill_leaves(boxes, order);
  Buffer<FloatBox> below(boxes.size());
  for (std::size_t i = 0; i < order.size(); ++i) below[i] = around[order[i]];
  for (levels_ = 1;; ++levels_) {
    Buffer<FloatBox> level((below.size() + kFanout - 1) / kFanout, kEmpty);
    for (std::size_t i = 0; i < below.size(); ++i) include(below[i], level[i / kFanout]);
    below = std::move(level);
    if (below.size() == 1) break;
    add_level(below);
  }
  bounds_ = below[0];
}

void BoxTree::fill_leaves(const Buffer<LeaningBox>& boxes, const Buffer<Index>& order) {
  leaves_.resize((boxes.size() + kFanout - 1) / kFanout);
  parallel_for(static_cast<std::ptrdiff_t>(leaves_.size()), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t n = begin; n < end; ++n) {
      for (int i = 0; i < kFanout; ++i) {
        const auto place = static_cast<std::size_t>(kFanout * n + i);
        LeaningBox box{};
        box.low = kEmpty.low;
        if (place < order.size()) box = boxes[order[place]];
        for (int c = 0; c < 3; ++c) {
          leaves_[n].centre[c][i] = box.centre[c];
          leaves_[n].first[c][i] = box.first[c];
          leaves_[n].second[c][i] = box.second[c];
          leaves_[n].low[c][i] = box.low[c];
          leaves_[n].high[c][i] = box.high[c];
        }
      }
    }
  });
}

void BoxTree::add_level(const Buffer<FloatBox>& below) {
  const std::size_t count = (below.size() + kFanout - 1) / kFanout;
  const std::size_t start = nodes_.size();
  level_start_[levels_] = static_cast<Index>(start);
  nodes_.resize(start + count);
  for (std::size_t place = 0; place < count * kFanout; ++place) {
    Node& node = nodes_[start + place / kFanout];
    const FloatBox& box = place < below.size() ? below[place] : kEmpty;
    for (int c = 0; c < 3; ++c) {
      node.low[c][place % kFanout] = box.low[c];
      node.high[c][place % kFanout] = box.high[c];
    }
  }
}

}  // namespace batten
