/// \file A frame that points themselves give, so that moved, turned and scaled they look the same in it.
#pragma once
#include <Eigen/Core>

#include "batten/types.h"

namespace batten {

/// A place in the frame is (place - centre) * axes / size; the axes are columns, right-handed.
struct OwnFrame {
  Eigen::RowVector3d centre = Eigen::RowVector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  double size = 1.0;

  Points into(ConstValuesRef points) const { return ((points.rowwise() - centre) * axes) / size; }
  Points back(ConstValuesRef points) const { return ((points * axes.transpose()) * size).rowwise() + centre; }
  Points turned(ConstValuesRef normals) const { return normals * axes; }
};

/// The frame of points that are not all at one place: the centre is their mean, the first axis goes through the point
/// farthest from it, which is 1 away in the frame, the second towards the point farthest from the first. Their order
/// changes no bit. Where several are as far, rounding chooses. O(N).
OwnFrame own_frame(ConstValuesRef points);

/// Coordinates of a frame as multiples of 2^-30: what rounding makes of a motion is gone, but for one in a million.
void drop_rounding(Points& values);

}  // namespace batten
