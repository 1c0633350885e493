/// \file Where the origin of a format of floats should lie.
#pragma once
#include <Eigen/Core>
#include <string>

#include "batten/mesh/mesh.h"

namespace batten::io {

/// The translation to write beside the points, and their bounds.
struct FloatFrame {
  /// Zero, or, where the points lie farther from the origin than their own size, their centre, in floats: a float keeps
  /// seven digits, and they are worth more for the shape than for the place.
  Eigen::RowVector3d origin = Eigen::RowVector3d::Zero();
  Eigen::RowVector3d low = Eigen::RowVector3d::Zero();  ///< of the points less the origin
  Eigen::RowVector3d high = Eigen::RowVector3d::Zero();
};

/// Throws Error(BadArgument) for coordinates beyond the floats; `name` is the file's.
FloatFrame float_frame(const std::string& name, const Points& points);

}  // namespace batten::io
