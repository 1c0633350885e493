#include "batten/volume/label_mask.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "batten/error.h"
#include "batten/volume/recursive_filter.h"

namespace batten {

namespace {

struct VoxelBox {
  std::array<Index, 3> low;
  std::array<Index, 3> high;
  bool is_empty() const { return high[0] < low[0]; }
};

template <typename Test>
VoxelBox box_of(const Volume& volume, const Test& has) {
  VoxelBox box{volume.grid.size, {-1, -1, -1}};
  for (Index k = 0; k < volume.grid.size[2]; ++k) {
    for (Index j = 0; j < volume.grid.size[1]; ++j) {
      for (Index i = 0; i < volume.grid.size[0]; ++i) {
        if (!has(volume.at(i, j, k))) continue;
        const std::array<Index, 3> at{i, j, k};
        for (int c = 0; c < 3; ++c) {
          box.low[c] = std::min(box.low[c], at[c]);
          box.high[c] = std::max(box.high[c], at[c]);
        }
      }
    }
  }
  return box;
}

[[noreturn]] void refuse(const Volume& volume, const std::vector<double>& labels) {
  constexpr std::size_t kMostListed = 12;
  std::set<float> there;
  for (const float value : volume.values) {
    if (value != 0.0F && there.size() <= kMostListed) there.insert(value);
  }
  std::string text;
  for (const float value : there) {
    if (!text.empty()) text += ", ";
    text += label_text(value);
  }
  if (there.size() > kMostListed) text += ", ...";
  const std::string which = labels.size() == 1 ? "the label " + label_text(labels.front()) : "any of the labels";
  throw Error(ErrorCode::BadArgument,
              "no voxel has " + which + "; there " + (there.empty() ? "is only 0" : "are " + text));
}

/// Places on a face across an index, evenly around its middle.
void add_face(const Eigen::Vector3d& middle, int axis, Index along, std::vector<Eigen::Vector3d>& places) {
  for (Index b = 0; b < along; ++b) {
    for (Index a = 0; a < along; ++a) {
      places.push_back(middle + ((a + 0.5) / along - 0.5) * Eigen::Vector3d::Unit((axis + 1) % 3) +
                       ((b + 0.5) / along - 0.5) * Eigen::Vector3d::Unit((axis + 2) % 3));
    }
  }
}

}  // namespace

std::string label_text(double label) {
  std::string number = std::to_string(label);
  number.erase(number.find_last_not_of('0') + 1);
  if (number.back() == '.') number.pop_back();
  return number;
}

Volume label_mask(const Volume& volume, const std::vector<double>& labels, Index margin) {
  require_volume(volume);
  if (margin < 0) throw Error(ErrorCode::BadArgument, "a margin is 0 voxels or more");
  std::set<double> met;
  const auto has = [&](float value) {
    if (labels.empty()) return value != 0.0F;
    return std::any_of(labels.begin(), labels.end(), [&](double label) { return label == value; });
  };
  const auto meet = [&](float value) {
    const bool is_in = has(value);
    if (is_in && (met.empty() || *met.rbegin() != value)) met.insert(value);
    return is_in;
  };
  const VoxelBox box = box_of(volume, meet);
  if (box.is_empty()) refuse(volume, labels);
  for (const double label : labels) {
    if (met.count(label) == 0) refuse(volume, {label});
  }
  Volume mask;
  mask.grid = volume.grid;
  Eigen::Vector3d low;
  for (int c = 0; c < 3; ++c) {
    low[c] = box.low[c] - margin;
    mask.grid.size[c] = box.high[c] - box.low[c] + 1 + 2 * margin;
  }
  mask.grid.origin = volume.grid.to_world(low);
  require_grid(mask.grid);
  mask.values.assign(static_cast<std::size_t>(mask.grid.count()), 0.0F);
  for (Index k = box.low[2]; k <= box.high[2]; ++k) {
    for (Index j = box.low[1]; j <= box.high[1]; ++j) {
      for (Index i = box.low[0]; i <= box.high[0]; ++i) {
        if (has(volume.at(i, j, k)))
          mask.values[mask.grid.voxel(i - box.low[0] + margin, j - box.low[1] + margin, k - box.low[2] + margin)] =
              1.0F;
      }
    }
  }
  return mask;
}

PointCloud mask_border(const Volume& mask, Index along) {
  constexpr double kAlpha = 1.2;  // of the mean spacing: smoothed over some two voxels
  require_volume(mask);
  if (along < 1) throw Error(ErrorCode::BadArgument, "a face has one point along its sides, or more");
  const VolumeGrid& grid = mask.grid;
  const Gradient slope = gradient(mask, kAlpha / std::cbrt(grid.voxel_volume()));
  std::vector<Eigen::Vector3d> places;
  for (Index k = 0; k < grid.size[2]; ++k) {
    for (Index j = 0; j < grid.size[1]; ++j) {
      for (Index i = 0; i < grid.size[0]; ++i) {
        const std::array<Index, 3> at{i, j, k};
        for (int axis = 0; axis < 3; ++axis) {
          if (at[axis] + 1 == grid.size[axis]) continue;
          std::array<Index, 3> next = at;
          ++next[axis];
          if (mask.at(i, j, k) == mask.at(next[0], next[1], next[2])) continue;
          add_face(Eigen::Vector3d(i, j, k) + 0.5 * Eigen::Vector3d::Unit(axis), axis, along, places);
        }
      }
    }
  }
  PointCloud border;
  border.points.resize(static_cast<Eigen::Index>(places.size()), 3);
  border.normals.resize(border.points.rows(), 3);
  for (Eigen::Index row = 0; row < border.points.rows(); ++row) {
    border.points.row(row) = grid.to_world(places[row]).transpose();
    border.normals.row(row) = -world_gradient(slope, places[row]).normalized().transpose();
  }
  return border;
}

double dice(const Volume& a, const Volume& b) {
  if (a.grid.size != b.grid.size) throw Error(ErrorCode::BadShape, "two masks to compare need one grid");
  double common = 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    const bool in_a = a.values[i] > 0.5F;
    const bool in_b = b.values[i] > 0.5F;
    common += in_a && in_b ? 1.0 : 0.0;
    sum += (in_a ? 1.0 : 0.0) + (in_b ? 1.0 : 0.0);
  }
  return sum > 0.0 ? 2.0 * common / sum : 1.0;
}

}  // namespace batten
