#include "batten/solve/krylov.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

namespace batten {
namespace {

Eigen::MatrixXd random_matrix(int n, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(n, n, [&] { return normal(generator); });
}

LinearMap map_of(const Eigen::MatrixXd& a) {
  return [&a](const Values& x, Values& y) { y = a * x; };
}

/// A symmetric positive definite matrix with eigenvalues in [1, 5], and a scale that hides the symmetry in its rows.
struct Scaled {
  Eigen::MatrixXd symmetric;
  Eigen::VectorXd scale;
  Eigen::MatrixXd matrix;
};
Scaled scaled_system(int n) {
  Scaled system;
  const Eigen::MatrixXd q = random_matrix(n, 1).householderQr().householderQ();
  system.symmetric = q * Eigen::VectorXd::LinSpaced(n, 1.0, 5.0).asDiagonal() * q.transpose();
  system.scale = Eigen::VectorXd::LinSpaced(n, 3.0, 9.0);
  system.matrix = system.scale.cwiseInverse().asDiagonal() * system.symmetric;
  return system;
}

TEST(ConjugateGradients, SolvesTheScaledSystemOfSeveralColumns) {
  const Scaled system = scaled_system(40);
  const Values truth = random_matrix(40, 2).leftCols(5);
  const Values b = system.matrix * truth;
  Values x = Values::Zero(40, 5);
  const SolveReport report =
      conjugate_gradients(map_of(system.matrix), system.scale, system.symmetric.diagonal(), b, x, {1e-13, 200, {}});
  EXPECT_TRUE(report.converged);
  EXPECT_LT((x - truth).cwiseAbs().maxCoeff(), 1e-11);  // 1e-13 times the largest scale over the least eigenvalue
}

TEST(ConjugateGradients, LeavesAColumnWithoutResidualAsItIs) {
  const Scaled system = scaled_system(20);
  Values b = Values::Zero(20, 2);
  b.col(1).setOnes();
  Values x = Values::Zero(20, 2);
  const SolveReport report =
      conjugate_gradients(map_of(system.matrix), system.scale, system.symmetric.diagonal(), b, x, {1e-12, 100, {}});
  EXPECT_TRUE(report.converged);
  EXPECT_TRUE((x.col(0).array() == 0.0).all());
}

TEST(ConjugateGradients, SaysWhenTheSystemIsIndefinite) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Identity(4, 4);
  a(3, 2) = a(2, 3) = 3.0;
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(4);
  Values b(4, 1);
  b << 1.0, 2.0, 3.0, -4.0;
  Values x = Values::Zero(4, 1);
  EXPECT_TRUE(conjugate_gradients(map_of(a), ones, ones, b, x, {1e-12, 100, {}}).indefinite);
}

TEST(BiCgStab, SolvesANonsymmetricSystem) {
  Eigen::MatrixXd a = 0.05 * random_matrix(60, 3);
  a.diagonal().array() += 2.0;
  const Values truth = random_matrix(60, 4).leftCols(3);
  const Values b = a * truth;
  Values x = Values::Zero(60, 3);
  const SolveReport report = bicgstab(map_of(a), a.diagonal(), b, x, {1e-12, 500, {}});
  EXPECT_TRUE(report.converged);
  EXPECT_LT((x - truth).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(MaxRowNorm, IsNotFooledByNaN) {
  Values values = Values::Ones(5000, 2);
  EXPECT_DOUBLE_EQ(max_row_norm(values), std::sqrt(2.0));
  values(1234, 1) = std::nan("");
  EXPECT_TRUE(std::isnan(max_row_norm(values)));
}

}  // namespace
}  // namespace batten
