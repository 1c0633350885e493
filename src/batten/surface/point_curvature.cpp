#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "batten/surface/limit_surface.h"

namespace batten {

PointCurvature curvature_of(const Jet& jet) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  PointCurvature result;
  const Eigen::Vector3d cross = jet.du.cross(jet.dv);
  const double length = cross.norm();
  result.normal = length > 0.0 ? Eigen::Vector3d(cross / length) : Eigen::Vector3d::Zero();
  result.mean = result.gaussian = result.greatest = result.least = kNone;
  result.greatest_direction.setConstant(kNone);
  result.least_direction.setConstant(kNone);
  if (!jet.regular || !(length > 0.0)) return result;
  const double e = jet.du.dot(jet.du);
  const double f = jet.du.dot(jet.dv);
  const double g = jet.dv.dot(jet.dv);
  const double area = length * length;
  // The second form with its sign turned: a sphere's outward normal points away from where it bends to.
  const double l = -jet.duu.dot(result.normal);
  const double m = -jet.duv.dot(result.normal);
  const double n = -jet.dvv.dot(result.normal);
  result.gaussian = (l * n - m * m) / area;
  result.mean = 0.5 * (e * n - 2.0 * f * m + g * l) / area;
  // In an orthonormal frame of the tangent plane the shape operator is symmetric.
  const double a = std::sqrt(e);
  const double b = f / a;
  const double c = length / a;
  const double s11 = l / e;
  const double s12 = (m - b / a * l) / (a * c);
  const double s22 = (n - 2.0 * b / a * m + b * b / e * l) / (c * c);
  const double spread = std::hypot(0.5 * (s11 - s22), s12);
  result.greatest = result.mean + spread;
  result.least = result.mean - spread;
  const double angle = 0.5 * std::atan2(s12, 0.5 * (s11 - s22));
  const Eigen::Vector3d x = jet.du / a;
  const Eigen::Vector3d y = result.normal.cross(x);
  result.greatest_direction = std::cos(angle) * x + std::sin(angle) * y;
  result.least_direction = result.normal.cross(result.greatest_direction);
  return result;
}

}  // namespace batten
