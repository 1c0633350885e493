#include "batten/fit/enclosing_sphere.h"

#include <Eigen/QR>
#include <cmath>
#include <vector>

namespace batten {

namespace {

constexpr double kRounding = 1e-12;

bool holds(const Sphere& sphere, const Eigen::Vector3d& point) {
  return (point - sphere.centre).norm() <= sphere.radius * (1.0 + kRounding);
}

/// The smallest sphere that has one to four points on it.
Sphere sphere_through(const std::vector<Eigen::Vector3d>& points) {
  const auto count = static_cast<Eigen::Index>(points.size()) - 1;
  if (count < 0) return {Eigen::Vector3d::Zero(), -1.0};
  if (count == 0) return {points[0], 0.0};
  Eigen::MatrixXd edges(3, count);
  for (Eigen::Index i = 0; i < count; ++i) edges.col(i) = points[static_cast<std::size_t>(i) + 1] - points[0];
  const Eigen::MatrixXd gram = 2.0 * edges.transpose() * edges;
  const Eigen::VectorXd squares = edges.colwise().squaredNorm().transpose();
  const Eigen::VectorXd shares = gram.completeOrthogonalDecomposition().solve(squares);
  const Eigen::Vector3d offset = edges * shares;
  return {points[0] + offset, offset.norm()};
}

/// Of the first `count` points, with `on` on the sphere.
Sphere smallest(const std::vector<Eigen::Vector3d>& points, std::size_t count, std::vector<Eigen::Vector3d>& on) {
  Sphere sphere = sphere_through(on);
  if (on.size() == 4) return sphere;
  for (std::size_t i = 0; i < count; ++i) {
    if (sphere.radius >= 0.0 && holds(sphere, points[i])) continue;
    on.push_back(points[i]);
    sphere = smallest(points, i, on);
    on.pop_back();
  }
  return sphere;
}

/// By coordinates: the sphere shall not depend on the order of points.
Eigen::Vector3d first_in_order(ConstValuesRef points) {
  Eigen::Index first = 0;
  for (Eigen::Index i = 1; i < points.rows(); ++i) {
    for (Eigen::Index c = 0; c < 3 && points(i, c) <= points(first, c); ++c) {
      if (points(i, c) == points(first, c)) continue;
      first = i;
      break;
    }
  }
  return points.row(first).transpose();
}

}  // namespace

Sphere enclosing_sphere(ConstValuesRef points) {
  constexpr int kMostPasses = 100;
  if (points.rows() == 0) return {};
  std::vector<Eigen::Vector3d> core{first_in_order(points)};
  Sphere sphere{core[0], 0.0};
  for (int pass = 0; pass < kMostPasses; ++pass) {
    Eigen::Index farthest = 0;
    (points.rowwise() - sphere.centre.transpose()).rowwise().squaredNorm().maxCoeff(&farthest);
    const Eigen::Vector3d point = points.row(farthest).transpose();
    if (holds(sphere, point)) break;
    core.insert(core.begin(), point);
    std::vector<Eigen::Vector3d> on;
    sphere = smallest(core, core.size(), on);
  }
  return sphere;
}

}  // namespace batten
