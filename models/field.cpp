#include <algorithm>
#include <cmath>

#include "shapes.h"

namespace batten::models {

double blend(double a, double b, double width) {
  const double near = std::max(width - std::abs(a - b), 0.0);
  return std::min(a, b) - (width > 0.0 ? near * near / (4.0 * width) : 0.0);
}

Eigen::Vector3d cast(const Field& field, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d unit = direction.normalized();
  double inside = 0.0;
  double outside = 0.0;
  while (field(origin + outside * unit) < 0.0) {
    inside = outside;
    outside += 0.02;
  }
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (inside + outside);
    (field(origin + middle * unit) < 0.0 ? inside : outside) = middle;
  }
  return origin + inside * unit;
}

Eigen::Vector3d settle(const Field& field, Eigen::Vector3d point) {
  constexpr double kStep = 1e-5;
  for (int i = 0; i < 8; ++i) {
    Eigen::Vector3d gradient;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
      gradient[axis] = (field(point + step) - field(point - step)) / (2.0 * kStep);
    }
    const double step = field(point) / std::max(gradient.norm(), 0.3);
    point -= std::clamp(step, -0.3, 0.3) * gradient.normalized();
  }
  return point;
}

}  // namespace batten::models
