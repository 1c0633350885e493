/// \file Squared distances from many planes as one quadratic form.
#pragma once
#include <Eigen/Core>

namespace batten {

/// x A x + 2 b x + c, and the weight that it sums.
struct Quadric {
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double c = 0.0;

  void add(const Quadric& other) {
    a += other.a;
    b += other.b;
    c += other.c;
  }
  /// The squared distance from the plane through `point`.
  void add_plane(const Eigen::Vector3d& normal, const Eigen::Vector3d& point, double weight) {
    const double offset = -normal.dot(point);
    a += weight * normal * normal.transpose();
    b += weight * offset * normal;
    c += weight * offset * offset;
  }
  void add_point(const Eigen::Vector3d& point, double weight) {
    a += weight * Eigen::Matrix3d::Identity();
    b -= weight * point;
    c += weight * point.squaredNorm();
  }
  double at(const Eigen::Vector3d& x) const { return x.dot(a * x) + 2.0 * b.dot(x) + c; }
};

}  // namespace batten
