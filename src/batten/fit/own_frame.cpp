#include "batten/fit/own_frame.h"

#include <Eigen/Geometry>
#include <bit>
#include <cmath>
#include <cstdint>

namespace batten {

namespace {

/// The sum of whole numbers does not depend on their order: as many bits of each coordinate count as their sum has
/// room for.
Eigen::RowVector3d mean_of(ConstValuesRef points) {
  constexpr int kBits = 61;
  const Eigen::RowVector3d low = points.colwise().minCoeff();
  const Eigen::RowVector3d high = points.colwise().maxCoeff();
  const Eigen::RowVector3d middle = 0.5 * low + 0.5 * high;
  const double reach = (high - middle).cwiseAbs().maxCoeff();
  const int bits = kBits - std::bit_width(static_cast<std::uint64_t>(points.rows()));
  const double unit = std::ldexp(reach, -bits);
  Eigen::RowVector3d mean = middle;
  for (Eigen::Index c = 0; c < 3; ++c) {
    std::int64_t sum = 0;
    for (Eigen::Index i = 0; i < points.rows(); ++i) sum += std::llround((points(i, c) - middle[c]) / unit);
    mean[c] += static_cast<double>(sum) / static_cast<double>(points.rows()) * unit;
  }
  return mean;
}

bool is_before(ConstValuesRef points, Eigen::Index a, Eigen::Index b) {
  for (Eigen::Index c = 0; c < 3; ++c) {
    if (points(a, c) != points(b, c)) return points(a, c) < points(b, c);
  }
  return false;
}

/// The row of the greatest value; of equals the first by coordinates.
template <typename Value>
Eigen::Index greatest(ConstValuesRef points, const Value& value) {
  Eigen::Index best = 0;
  double most = value(0);
  for (Eigen::Index i = 1; i < points.rows(); ++i) {
    const double here = value(i);
    if (here < most || (here == most && !is_before(points, i, best))) continue;
    most = here;
    best = i;
  }
  return best;
}

}  // namespace

OwnFrame own_frame(ConstValuesRef points) {
  OwnFrame frame;
  frame.centre = mean_of(points);
  const auto offset = [&](Eigen::Index i) -> Eigen::RowVector3d { return points.row(i) - frame.centre; };
  const Eigen::RowVector3d farthest = offset(greatest(points, [&](Eigen::Index i) { return offset(i).squaredNorm(); }));
  frame.size = farthest.norm();
  const Eigen::RowVector3d first = farthest / frame.size;
  const auto aside = [&](Eigen::Index i) -> Eigen::RowVector3d { return offset(i) - offset(i).dot(first) * first; };
  Eigen::RowVector3d second = aside(greatest(points, [&](Eigen::Index i) { return aside(i).squaredNorm(); }));
  // Points on a line have no second axis of their own.
  constexpr double kOnLine = 1e-9;
  if (!(second.norm() > kOnLine * frame.size)) second = first.unitOrthogonal();
  second = (second - second.dot(first) * first).normalized();
  frame.axes.col(0) = first.transpose();
  frame.axes.col(1) = second.transpose();
  frame.axes.col(2) = first.cross(second).transpose();
  return frame;
}

void drop_rounding(Points& values) {
  constexpr int kBits = 30;
  const double scale = std::ldexp(1.0, kBits);
  values = (values * scale).array().round().matrix() / scale;
}

}  // namespace batten
