/// Conjugate gradients with an incomplete factor.
#include "batten/solve/incomplete_factor.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <vector>

#include "batten/parallel/threads.h"
#include "batten/solve/krylov.h"
#include "support/dense.h"
#include "support/errors.h"
#include "support/values.h"

namespace batten {
namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// The squared Laplacian of a line, and a little of the identity: a condition number of 1e6.
Matrix bending_of_a_line(int count) {
  Matrix slope(count, count);
  for (int i = 0; i < count; ++i) {
    slope.insert(i, i) = 2.0;
    if (i > 0) slope.insert(i, i - 1) = -1.0;
    if (i + 1 < count) slope.insert(i, i + 1) = -1.0;
  }
  Matrix matrix = slope * slope;
  for (int i = 0; i < count; ++i) matrix.coeffRef(i, i) += 1e-5;
  return matrix;
}

SolveReport solve(const Matrix& matrix, const Values& right, Coefficients coefficients, bool with_factor, Values& x) {
  const IncompleteFactor factor(matrix);
  const auto precondition = [&](const Values& b, Values& z) {
    if (with_factor) return factor.solve(b, z);
    z = b;
  };
  x = Values::Zero(right.rows(), right.cols());
  return conjugate_gradients([&](const Values& p, Values& q) { q = matrix * p; }, precondition, coefficients, right, x,
                             {1e-9, 4000, {}});
}

/// Within a band nothing is left out.
TEST(IncompleteFactor, IsTheWholeFactorWhereNothingFillsIn) {
  const Matrix matrix = bending_of_a_line(60);
  const Values right = test::random_values(60, 5);
  Values x;
  IncompleteFactor(matrix).solve(right, x);
  EXPECT_LT((matrix * x - right).norm(), 1e-9 * right.norm());
}

/// The squared Laplacian of a square of side * side places.
Matrix bending_of_a_plate(int side) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const int here = side * i + j;
      entries.emplace_back(here, here, 4.0);
      if (i > 0) entries.emplace_back(here, here - side, -1.0);
      if (j > 0) entries.emplace_back(here, here - 1, -1.0);
      if (i + 1 < side) entries.emplace_back(here, here + side, -1.0);
      if (j + 1 < side) entries.emplace_back(here, here + 1, -1.0);
    }
  }
  Matrix laplacian(side * side, side * side);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  return laplacian * laplacian;
}

/// Next to the matrix, the inverse of what a factor solves. Returns how far they are apart where the matrix has no
/// entry.
double expect_equal_entries(const Matrix& matrix, const IncompleteFactor& factor) {
  Values inverse;
  factor.solve(Values::Identity(matrix.rows(), matrix.rows()), inverse);
  Eigen::MatrixXd rest = Eigen::MatrixXd(inverse).inverse();
  for (int i = 0; i < static_cast<int>(matrix.rows()); ++i) {
    for (Matrix::InnerIterator entry(matrix, i); entry; ++entry) {
      EXPECT_NEAR(rest(i, entry.col()), entry.value(), 1e-11) << i << ", " << entry.col();
      rest(i, entry.col()) = 0.0;
    }
  }
  return rest.cwiseAbs().maxCoeff();
}

TEST(IncompleteFactor, EqualsTheMatrixWhereThatHasEntries) {
  const Matrix matrix = bending_of_a_plate(6);
  EXPECT_GT(expect_equal_entries(matrix, IncompleteFactor(matrix)), 1e-3);
}

/// Rows between two parts come after both, which fills in: there, and only there, the factor differs from the matrix.
TEST(IncompleteFactor, EqualsTheMatrixWhereThatHasEntriesInParts) {
  Matrix matrix = bending_of_a_line(90);
  for (int i = 0; i < 90; ++i) matrix.coeffRef(i, i) += 2.0;
  const IncompleteFactor factor(matrix, 10);
  EXPECT_GT(factor.part_count(), 4);
  EXPECT_GT(expect_equal_entries(matrix, factor), 1e-3);
}

TEST(IncompleteFactor, HasOnePartWhereTheBandIsWide) {
  Matrix matrix = bending_of_a_line(90);
  matrix.insert(0, 89) = 0.01;
  matrix.insert(89, 0) = 0.01;
  matrix.makeCompressed();
  EXPECT_EQ(IncompleteFactor(matrix, 10).part_count(), 1);
}

TEST(IncompleteFactor, DoesNotDependOnTheNumberOfThreads) {
  const Matrix matrix = bending_of_a_line(9000);
  const Values right = test::random_values(9000, 3);
  Values expected;
  const IncompleteFactor factor(matrix);
  EXPECT_GT(factor.part_count(), 2);
  factor.solve(right, expected);
  const ThreadLimit one(1);
  Values x;
  IncompleteFactor(matrix).solve(right, x);
  EXPECT_EQ(x, expected);
}

/// Positive definite, and yet its factor without what fills in would have the root of a negative number (Kershaw 1978).
TEST(IncompleteFactor, GrowsTheDiagonalWhereItWouldNotBePositive) {
  Eigen::Matrix4d full;
  full << 3.0, -2.0, 0.0, 2.0, -2.0, 3.0, -2.0, 0.0, 0.0, -2.0, 3.0, -2.0, 2.0, 0.0, -2.0, 3.0;
  Values x;
  IncompleteFactor(Matrix(full.sparseView())).solve(Values::Identity(4, 4), x);
  EXPECT_GT(test::symmetric_modes(x).values.minCoeff(), 0.0);
}

TEST(IncompleteFactor, RefusesNumbersThatAreNotFinite) {
  Matrix matrix = bending_of_a_line(5);
  matrix.coeffRef(2, 1) = matrix.coeffRef(1, 2) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(test::code_of([&] { IncompleteFactor{matrix}; }), ErrorCode::NotFinite);
}

TEST(IncompleteFactor, SavesIterations) {
  const Matrix matrix = bending_of_a_plate(14);
  const Values right = test::random_values(196, 3);
  Values x;
  const SolveReport plain = solve(matrix, right, Coefficients::EachColumn, false, x);
  const SolveReport fast = solve(matrix, right, Coefficients::EachColumn, true, x);
  EXPECT_TRUE(fast.converged);
  EXPECT_LT(3 * fast.iterations, 2 * plain.iterations);
  EXPECT_LT((matrix * x - right).norm(), 1e-7 * right.norm());
}

/// A matrix that mixes columns needs one coefficient for all: x -> A x R with R symmetric and positive definite.
TEST(ConjugateGradients, TakesColumnsForOneVectorWhereTheMatrixMixesThem) {
  const Matrix matrix = bending_of_a_line(30);
  Eigen::Matrix3d mix;
  mix << 2.0, 0.5, 0.1, 0.5, 1.0, -0.3, 0.1, -0.3, 3.0;
  const Values right = test::random_values(30, 3);
  const IncompleteFactor factor(matrix);
  Values x = Values::Zero(30, 3);
  const SolveReport report = conjugate_gradients([&](const Values& p, Values& q) { q = matrix * p * mix; },
                                                 [&](const Values& b, Values& z) { factor.solve(b, z); },
                                                 Coefficients::Joint, right, x, {1e-10, 400, {}});
  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.iterations, 4);  // the mixing matrix has three eigenvalues
  EXPECT_LT((matrix * x * mix - right).norm(), 1e-7 * right.norm());
}

}  // namespace
}  // namespace batten
