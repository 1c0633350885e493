#include "batten/energy/congruence.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <random>

namespace batten {
namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// A number in every third place or so.
Eigen::MatrixXd thin_matrix(int rows, int columns, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  Eigen::MatrixXd matrix(rows, columns);
  for (double& entry : matrix.reshaped()) entry = std::max(0.0, number(random) - 0.3);
  return matrix;
}

TEST(Congruence, IsTheProductOfDenseMatrices) {
  const Eigen::MatrixXd half = thin_matrix(40, 40, 1);
  const Eigen::MatrixXd form = half + half.transpose();
  const Eigen::MatrixXd map = thin_matrix(40, 25, 2);
  const Matrix result = congruence(Matrix(form.sparseView()), Matrix(map.sparseView()));
  EXPECT_LT((Eigen::MatrixXd(result) - map.transpose() * form * map).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(Congruence, HasItsDiagonalAlsoWhereThatIsZero) {
  const Matrix result = congruence(Matrix(3, 3), Matrix(3, 2));
  EXPECT_EQ(result.nonZeros(), 2);
  EXPECT_EQ(Eigen::MatrixXd(result), Eigen::MatrixXd::Zero(2, 2));
}

}  // namespace
}  // namespace batten
