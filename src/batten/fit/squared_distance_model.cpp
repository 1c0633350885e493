#include "batten/fit/squared_distance_model.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace batten {

namespace {

/// Of the squared cosine between offset and normal: beside creases and boundaries it is less.
constexpr double kAlongNormal = 0.9;

Form outer(double weight, const Eigen::Vector3d& a) {
  return {weight * a[0] * a[0], weight * a[0] * a[1], weight * a[0] * a[2],
          weight * a[1] * a[1], weight * a[1] * a[2], weight * a[2] * a[2]};
}

}  // namespace

Form distance_form(const Jet& jet, const Eigen::Vector3d& offset) {
  const Eigen::Vector3d cross = jet.du.cross(jet.dv);
  const double length = cross.norm();
  if (!(length > 0.0)) return kPointForm;
  const Eigen::Vector3d normal = cross / length;
  const double squared = offset.squaredNorm();
  const double along = normal.dot(offset);
  if (along * along < kAlongNormal * squared) return kPointForm;
  const PointCurvature curvature = curvature_of(jet);
  Form form = outer(1.0, normal);
  const auto add = [&](double bend, const Eigen::Vector3d& direction) {
    // |d| / (|d| + r) with r = 1 / |bend|.
    const double part = std::abs(along * bend) / (1.0 + std::abs(along * bend));
    if (!(part >= 0.0)) return;
    const Form one = outer(part, direction);
    for (std::size_t i = 0; i < form.size(); ++i) form[i] += one[i];
  };
  add(curvature.greatest, curvature.greatest_direction);
  add(curvature.least, curvature.least_direction);
  return form;
}

Form plane_form(const Eigen::Vector3d& normal, const Eigen::Vector3d& offset, double spacing) {
  const double along = (offset - normal.dot(offset) * normal).norm();
  const double beyond = std::max(0.0, along - 2.0 * spacing);
  const double part = beyond > 0.0 ? beyond / (beyond + 2.0 * spacing) : 0.0;
  Form form = outer(1.0 - part, normal);
  form[0] += part;
  form[3] += part;
  form[5] += part;
  return form;
}

}  // namespace batten
