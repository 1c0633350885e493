#include "fuzz/few_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace batten::fuzz {

namespace {

/// A point from three bytes: anywhere on a grid, or on a ball or a ring that most bytes lie on.
Eigen::RowVector3d point_of(int shape, int a, int b, int c) {
  if (shape == 0) return Eigen::RowVector3d(a, b, c) / 16.0;
  const double u = a * 0.0245437;
  const double v = b * 0.0245437;
  const double off = 1.0 + (c > 240 ? 0.2 * (c - 240) : 1e-3 * c);
  if (shape == 1) return off * Eigen::RowVector3d(std::cos(u) * std::sin(v), std::sin(u) * std::sin(v), std::cos(v));
  if (shape == 2)
    return {(2.0 + off * std::cos(v)) * std::cos(u), (2.0 + off * std::cos(v)) * std::sin(u), off * std::sin(v)};
  return {a / 64.0, b / 64.0, c > 250 ? 0.1 * c : 0.0};
}

}  // namespace

PointCloud few_points(int kind, Bytes& bytes, std::size_t most) {
  const int shape = kind >> 4 & 3;
  const bool has_normals = (kind & 64) != 0;
  constexpr std::array<double, 6> kScales{1.0, 1.0, 1e-300, 1e300, 1e-9, 1e9};
  const double scale = (kind & 128) != 0 ? kScales[bytes.take() % 6] : 1.0;
  // Each triple of bytes stands for three points, so that few bytes make a surface.
  const auto count = static_cast<Index>(std::min(most, bytes.left() / 3));
  PointCloud cloud;
  cloud.points.resize(3 * count, 3);
  for (Index i = 0; i < count; ++i) {
    const int a = bytes.take();
    const int b = bytes.take();
    const int c = bytes.take();
    cloud.points.row(3 * i) = scale * point_of(shape, a, b, c);
    cloud.points.row(3 * i + 1) = scale * point_of(shape, (a + 85) % 256, (b * 7 + 31) % 256, c);
    cloud.points.row(3 * i + 2) = scale * point_of(shape, (a * 5 + 170) % 256, (b + 100) % 256, c);
    if (a == 255 && c == 255) cloud.points(3 * i, 1) = std::numeric_limits<double>::quiet_NaN();
  }
  if (has_normals) cloud.normals = cloud.points / scale;
  return cloud;
}

PointCloud reversed(const PointCloud& cloud) {
  return {cloud.points.colwise().reverse(), cloud.normals.colwise().reverse()};
}

}  // namespace batten::fuzz
