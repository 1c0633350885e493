/// \file The smallest sphere around points.
#pragma once
#include <Eigen/Core>

#include "batten/types.h"

namespace batten {

/// A ball in space.
struct Sphere {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0.0;
};

/// The smallest sphere that holds all points, to some 1e-12 of its radius. points: N-by-3, finite; none gives radius 0.
/// After Welzl 1991 (key W91) on the few points that matter: the farthest point outside joins them until there is none.
/// Some ten passes over the points.
Sphere enclosing_sphere(ConstValuesRef points);

}  // namespace batten
