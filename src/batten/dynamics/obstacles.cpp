#include <algorithm>
#include <cmath>

#include "batten/dynamics/contact.h"
#include "batten/dynamics/force_checks.h"
#include "batten/error.h"

namespace batten {

SignedDistance plane_obstacle(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
  require_finite_vector(point, "the point of a plane");
  require_finite_vector(normal, "the normal of a plane");
  const Eigen::Vector3d unit = normal.stableNormalized();
  if (normal.isZero(0.0)) throw Error(ErrorCode::BadArgument, "the normal of a plane is 0");
  return [point, unit](const Eigen::Vector3d& at, Eigen::Vector3d& gradient) {
    gradient = unit;
    return unit.dot(at - point);
  };
}

SignedDistance sphere_obstacle(const Eigen::Vector3d& center, double radius) {
  require_finite_vector(center, "the centre of a sphere");
  require_not_negative(radius, "the radius of a sphere");
  if (radius == 0.0) throw Error(ErrorCode::BadArgument, "the radius of a sphere is 0");
  return [center, radius](const Eigen::Vector3d& at, Eigen::Vector3d& gradient) {
    gradient = at - center;
    const double distance = gradient.norm();
    if (distance == 0.0) gradient = Eigen::Vector3d::UnitZ();
    return distance - radius;
  };
}

SignedDistance box_inside_obstacle(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  require_finite_vector(low, "the low corner of a box");
  require_finite_vector(high, "the high corner of a box");
  if ((low.array() >= high.array()).any()) {
    throw Error(ErrorCode::BadArgument,
                "a box from " + describe(low) + " to " + describe(high) + " has nothing inside");
  }
  return [low, high](const Eigen::Vector3d& at, Eigen::Vector3d& gradient) {
    const Eigen::Vector3d inward = at.cwiseMax(low).cwiseMin(high) - at;
    const double outside = inward.norm();
    if (outside > 0.0) {
      gradient = inward;
      return -outside;
    }
    Eigen::Index side = 0;
    const double nearest = (at - low).cwiseMin(high - at).minCoeff(&side);
    gradient = Eigen::Vector3d::Unit(side) * (at[side] - low[side] == nearest ? 1.0 : -1.0);
    return nearest;
  };
}

}  // namespace batten
