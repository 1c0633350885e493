/// \file The rotation that fits two shapes best.
#pragma once
#include <Eigen/Core>

namespace batten {

/// The rotation R (determinant 1) that makes trace(R^T A) greatest, for any A. With A = sum of w p r^T over points p
/// and their places r at rest, the weighted squared distances of the p from the R r are least.
struct BestRotation {
  Eigen::Matrix3d matrix;
  double trace;  ///< trace(R^T A)
};

/// By the greatest eigenvalue of a 4-by-4 matrix of quaternions (after Horn 1987, key H87, with Newton's method as in
/// Theobald 2005, key T05). Where several rotations are equally good, one of them, always the same for the same A.
/// Rounding: of the rotation that of A relative to the gap between its singular values' sums.
BestRotation best_rotation(const Eigen::Matrix3d& a);

}  // namespace batten
