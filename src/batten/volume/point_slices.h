/// \file Points that lie in parallel slices.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "batten/types.h"

namespace batten {

/// Points of parallel planes, plane by plane.
struct PointSlices {
  /// Columns of length 1 at right angles: two along the slices and one across them.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  std::vector<double> levels;                   ///< along the last axis, growing
  std::vector<std::vector<Eigen::Index>> rows;  ///< of the points, those of each slice
};

/// The slices that points lie in, in any direction and order, if they do: two slices at least, of six points in the
/// mean, each of them thinner than a quarter of the distance between neighbours, which is not greater than that between
/// slices. points: N-by-3. O(N log N). Throws Error(NotFinite).
std::optional<PointSlices> find_slices(const Points& points);

}  // namespace batten
