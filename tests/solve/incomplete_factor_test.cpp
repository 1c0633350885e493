/// Conjugate gradients with an incomplete factor.
#include "batten/solve/incomplete_factor.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <vector>

#include "batten/solve/krylov.h"
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
                             {.tolerance = 1e-9, .max_iterations = 4000});
}

/// Within a band nothing is left out.
TEST(IncompleteFactor, IsTheWholeFactorWhereNothingFillsIn) {
  const Matrix matrix = bending_of_a_line(60);
  const Values right = test::random_values(60, 5);
  Values x;
  IncompleteFactor(matrix).solve(right, x);
  EXPECT_LT((matrix * x - right).norm(), 1e-9 * right.norm());
}

TEST(IncompleteFactor, SavesIterations) {
  constexpr int kSide = 14;
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const int here = kSide * i + j;
      entries.emplace_back(here, here, 4.0);
      if (i > 0) entries.emplace_back(here, here - kSide, -1.0);
      if (j > 0) entries.emplace_back(here, here - 1, -1.0);
      if (i + 1 < kSide) entries.emplace_back(here, here + kSide, -1.0);
      if (j + 1 < kSide) entries.emplace_back(here, here + 1, -1.0);
    }
  }
  Matrix laplacian(kSide * kSide, kSide * kSide);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  const Matrix matrix = laplacian * laplacian;  // a plate
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
  const SolveReport report =
      conjugate_gradients([&](const Values& p, Values& q) { q = matrix * p * mix; },
                          [&](const Values& b, Values& z) { factor.solve(b, z); }, Coefficients::Joint, right, x,
                          {.tolerance = 1e-10, .max_iterations = 400});
  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.iterations, 4);  // the mixing matrix has three eigenvalues
  EXPECT_LT((matrix * x * mix - right).norm(), 1e-7 * right.norm());
}

}  // namespace
}  // namespace batten
