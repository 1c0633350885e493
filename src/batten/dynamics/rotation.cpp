#include "batten/dynamics/rotation.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

namespace batten {

namespace {

/// q^T N q = trace(R(q)^T A) for unit quaternions q = (w, x, y, z).
Eigen::Matrix4d quaternion_form(const Eigen::Matrix3d& a) {
  Eigen::Matrix4d n;
  n << a(0, 0) + a(1, 1) + a(2, 2), a(2, 1) - a(1, 2), a(0, 2) - a(2, 0), a(1, 0) - a(0, 1),  //
      0.0, a(0, 0) - a(1, 1) - a(2, 2), a(0, 1) + a(1, 0), a(2, 0) + a(0, 2),                 //
      0.0, 0.0, a(1, 1) - a(0, 0) - a(2, 2), a(1, 2) + a(2, 1),                               //
      0.0, 0.0, 0.0, a(2, 2) - a(0, 0) - a(1, 1);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < i; ++j) n(i, j) = n(j, i);
  }
  return n;
}

double determinant3(double a, double b, double c, double d, double e, double f, double g, double h, double i) {
  return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g);
}

/// The greatest root of N's characteristic polynomial x^4 + c2 x^2 + c1 x + c0, from above; A's largest entry is 1, so
/// that it is at most 3 * sqrt(3).
double greatest_eigenvalue(const Eigen::Matrix3d& a, const Eigen::Matrix4d& n) {
  const double c2 = -2.0 * a.squaredNorm();
  const double c1 = -8.0 * a.determinant();
  const double c0 = n.determinant();
  double x = std::sqrt(3.0) * a.norm();
  for (int i = 0; i < 50; ++i) {
    const double value = ((x * x + c2) * x + c1) * x + c0;
    const double slope = (4.0 * x * x + 2.0 * c2) * x + c1;
    if (!(slope > 0.0)) break;
    const double step = value / slope;
    x -= step;
    if (std::abs(step) <= 1e-15 * x) break;
  }
  return x;
}

/// The column of the adjugate of B, singular and symmetric, with the largest entry on its diagonal: B's null vector.
Eigen::Vector4d null_vector(const Eigen::Matrix4d& b) {
  Eigen::Matrix4d adjugate;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      const int r0 = i == 0 ? 1 : 0;
      const int r1 = i <= 1 ? 2 : 1;
      const int r2 = i <= 2 ? 3 : 2;
      const int c0 = j == 0 ? 1 : 0;
      const int c1 = j <= 1 ? 2 : 1;
      const int c2 = j <= 2 ? 3 : 2;
      const double minor = determinant3(b(r0, c0), b(r0, c1), b(r0, c2), b(r1, c0), b(r1, c1), b(r1, c2), b(r2, c0),
                                        b(r2, c1), b(r2, c2));
      adjugate(i, j) = (i + j) % 2 == 0 ? minor : -minor;
    }
  }
  int best = 0;
  for (int j = 1; j < 4; ++j) {
    if (std::abs(adjugate(j, j)) > std::abs(adjugate(best, best))) best = j;
  }
  return adjugate.col(best);
}

Eigen::Matrix3d rotation_of(Eigen::Vector4d q) {
  q.normalize();
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

}  // namespace

BestRotation best_rotation(const Eigen::Matrix3d& a) {
  const double scale = a.cwiseAbs().maxCoeff();
  if (!(scale > 0.0)) return {Eigen::Matrix3d::Identity(), 0.0};
  const Eigen::Matrix3d scaled = a / scale;
  const Eigen::Matrix4d n = quaternion_form(scaled);
  const double eigenvalue = greatest_eigenvalue(scaled, n);
  const Eigen::Vector4d q = null_vector(n - eigenvalue * Eigen::Matrix4d::Identity());
  // The adjugate is the product of the three other gaps: too small where two eigenvalues are close.
  constexpr double kSmallGap = 1e-3;
  Eigen::Matrix3d rotation;
  if (q.norm() > kSmallGap) {
    rotation = rotation_of(q);
  } else {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(n);
    rotation = rotation_of(solver.eigenvectors().col(3));
  }
  return {rotation, rotation.cwiseProduct(a).sum()};
}

}  // namespace batten
