#include "batten/dynamics/rotation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <random>

namespace batten {
namespace {

Eigen::Matrix3d random_matrix(std::mt19937& random) {
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  Eigen::Matrix3d a;
  for (int i = 0; i < 9; ++i) a.data()[i] = number(random);
  return a;
}

/// The sum of the singular values, the least one with the sign of the determinant.
double greatest_trace(const Eigen::Matrix3d& a) {
  const Eigen::Vector3d values = Eigen::JacobiSVD<Eigen::Matrix3d>(a).singularValues();
  return values[0] + values[1] + (a.determinant() < 0.0 ? -values[2] : values[2]);
}

void expect_best(const Eigen::Matrix3d& a) {
  const BestRotation best = best_rotation(a);
  const double scale = a.norm();
  EXPECT_LE((best.matrix * best.matrix.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  EXPECT_NEAR(best.matrix.determinant(), 1.0, 1e-14);
  EXPECT_NEAR(best.trace, best.matrix.cwiseProduct(a).sum(), 1e-14 * scale);
  EXPECT_NEAR(best.trace, greatest_trace(a), 1e-13 * scale);
}

TEST(BestRotation, HasTheGreatestTrace) {
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) expect_best(random_matrix(random));
}

TEST(BestRotation, HasTheGreatestTraceOfFlatAndThinShapes) {
  std::mt19937 random(2);
  for (int i = 0; i < 300; ++i) {
    const Eigen::Matrix3d a = random_matrix(random);
    Eigen::Matrix3d flat = a;
    flat.col(1).setZero();
    expect_best(flat);
    expect_best(a.col(0) * a.row(1));
    expect_best(1e-100 * flat);
    expect_best(Eigen::Vector3d(2.0, 1.0, -1.0).asDiagonal() * best_rotation(a).matrix);  // two are equally good
  }
}

TEST(BestRotation, FindsTheRotationOfAShape) {
  std::mt19937 random(3);
  for (const double angle : {1e-9, 0.5, 2.0, 3.14159265358979}) {
    const Eigen::Vector3d axis = random_matrix(random).col(0).normalized();
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    const Eigen::Matrix3d half = random_matrix(random);
    EXPECT_LE((best_rotation(turn * half * half.transpose()).matrix - turn).norm(), 1e-12) << angle;
  }
}

TEST(BestRotation, OfNothingIsTheIdentity) {
  EXPECT_EQ(best_rotation(Eigen::Matrix3d::Zero()).matrix, Eigen::Matrix3d::Identity());
}

}  // namespace
}  // namespace batten
