/// \file The distance from a point to a line segment.
#pragma once
#include <Eigen/Core>
#include <algorithm>

namespace batten {

/// The distance from p to the segment from a to b. The segment may be a single point.
inline double distance_to_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = b - a;
  const double square = along.squaredNorm();
  const double t = square > 0.0 ? std::clamp((p - a).dot(along) / square, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
}

}  // namespace batten
