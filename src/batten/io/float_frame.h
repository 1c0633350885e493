/// \file The origin to write in formats that store coordinates as floats.
#pragma once
#include <Eigen/Core>
#include <string>

#include "batten/mesh/mesh.h"

namespace batten::io {

/// The translation that is written beside the points, and the points' bounds.
struct FloatFrame {
  /// Zero, or the centre of the points, rounded to float, if they are farther from the origin than their own size. A
  /// float has seven digits, which should describe the shape rather than the position.
  Eigen::RowVector3d origin = Eigen::RowVector3d::Zero();
  Eigen::RowVector3d low = Eigen::RowVector3d::Zero();  ///< of the points minus the origin
  Eigen::RowVector3d high = Eigen::RowVector3d::Zero();
};

/// `name` is the file's. Throws Error(BadArgument) for coordinates outside the range of float.
FloatFrame float_frame(const std::string& name, const Points& points);

}  // namespace batten::io
