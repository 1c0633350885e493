#include "batten/solve/cholesky_factor.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>
#include <vector>

#include "batten/parallel/threads.h"
#include "support/values.h"

namespace batten {
namespace {

using Matrix = CholeskyFactor::Matrix;

Matrix symmetric(int size, const std::vector<Eigen::Triplet<double>>& lower) {
  std::vector<Eigen::Triplet<double>> all = lower;
  for (const auto& entry : lower) {
    if (entry.row() != entry.col()) all.emplace_back(entry.col(), entry.row(), entry.value());
  }
  Matrix matrix(size, size);
  matrix.setFromTriplets(all.begin(), all.end());
  return matrix;
}

/// Diagonally dominant, with about `degree` random entries a row.
Matrix random_matrix(int size, int degree, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < size; ++i) {
    entries.emplace_back(i, i, 2.0 * degree);
    for (int k = 0; i > 0 && k < degree / 2; ++k) {
      entries.emplace_back(i, static_cast<int>(random() % static_cast<unsigned>(i)), number(random));
    }
  }
  return symmetric(size, entries);
}

/// A grid of size by size nodes, each joined to those up to two away: wide supernodes.
Matrix grid_matrix(int size) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < size * size; ++i) {
    entries.emplace_back(i, i, 1.0 + 0.001 * i);
    for (int dx = -2; dx <= 2; ++dx) {
      for (int dy = -2; dy <= 2; ++dy) {
        const int x = i % size + dx;
        const int y = i / size + dy;
        if (x < 0 || y < 0 || x >= size || y >= size || y * size + x >= i) continue;
        entries.emplace_back(i, y * size + x, -0.04);
      }
    }
  }
  return symmetric(size * size, entries);
}

void expect_solves(const Matrix& matrix, const std::string& name) {
  const CholeskyFactor factor(matrix);
  ASSERT_TRUE(factor.positive()) << name;
  for (const Index columns : {1, 3, 5}) {
    const Values b = test::random_values(static_cast<Index>(matrix.rows()), columns);
    Values x;
    factor.solve(b, x);
    EXPECT_LE((matrix * x - b).norm(), 1e-12 * b.norm()) << name << ", " << columns;
  }
}

TEST(CholeskyFactor, SolvesMatricesOfEveryKind) {
  for (const int size : {1, 2, 3, 7, 50, 300}) expect_solves(random_matrix(size, 6, 1), std::to_string(size));
  expect_solves(random_matrix(150, 60, 2), "nearly full");
  expect_solves(random_matrix(200, 1, 3), "diagonal");
  expect_solves(grid_matrix(40), "grid");
  std::vector<Eigen::Triplet<double>> arrow;
  for (int i = 0; i < 60; ++i) {
    arrow.emplace_back(i, i, 100.0);
    if (i > 0) arrow.emplace_back(i, 0, 1.0);
  }
  expect_solves(symmetric(60, arrow), "arrow");
  std::vector<Eigen::Triplet<double>> chain;
  for (int i = 0; i < 60; ++i) {
    chain.emplace_back(i, i, 2.1);
    if (i > 0) chain.emplace_back(i, i - 1, -1.0);
  }
  expect_solves(symmetric(60, chain), "chain");
}

TEST(CholeskyFactor, LeastPivotIsThatOfADenseFactor) {
  // Of a chain each pivot follows from the last, whatever the order of elimination does to the others: here it must be
  // the natural one, from an end.
  std::vector<Eigen::Triplet<double>> star;
  for (int i = 0; i < 5; ++i) star.emplace_back(i, i, 1.0);
  for (int i = 0; i < 4; ++i) star.emplace_back(4, i, 0.4);
  const CholeskyFactor factor(symmetric(5, star));
  EXPECT_NEAR(factor.least_pivot(), 1.0 - 4 * 0.16, 1e-15);
}

TEST(CholeskyFactor, SeesWhatIsNotPositiveDefinite) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < 100; ++i) {
    entries.emplace_back(i, i, i == 0 || i == 99 ? 1.0 : 2.0);
    if (i > 0) entries.emplace_back(i, i - 1, -1.0);
  }
  const CholeskyFactor singular(symmetric(100, entries));  // a free chain: constants are in its null space
  EXPECT_TRUE(!singular.positive() || singular.least_pivot() < 1e-14);
  entries.emplace_back(50, 50, -1.0);
  EXPECT_FALSE(CholeskyFactor(symmetric(100, entries)).positive());
}

/// Large enough that subtrees are taken by several threads.
Values solution_on(int threads, const Matrix& matrix, const Values& b,
                   FactorPrecision precision = FactorPrecision::Double) {
  const ThreadLimit limit(threads);
  Values x;
  CholeskyFactor(matrix, precision).solve(b, x);
  return x;
}

TEST(CholeskyFactor, HasTheSameBitsOnAnyNumberOfThreads) {
  const Matrix matrix = grid_matrix(90);
  ASSERT_GT(CholeskyFactor(matrix).entry_count(), 500'000U);
  const Values b = test::random_values(static_cast<Index>(matrix.rows()), 3);
  const Values alone = solution_on(1, matrix, b);
  EXPECT_EQ(alone, solution_on(4, matrix, b));
  EXPECT_LE((matrix * alone - b).norm(), 1e-12 * b.norm());
}

/// Its solutions are near, and mending them by their residuals comes to double precision.
TEST(CholeskyFactor, SinglePrecisionIsAPreconditioner) {
  const Matrix matrix = grid_matrix(90);
  for (const double unit : {1.0, 1e-60, 1e60}) {
    // Of very different sizes, as of a body whose parts have different masses.
    Matrix scaled = matrix;
    for (int row = 0; row < scaled.rows(); ++row) {
      for (Matrix::InnerIterator e(scaled, row); e; ++e) {
        e.valueRef() *= unit * std::pow(10.0, 0.5 * ((row % 5) + (e.col() % 5)));
      }
    }
    const CholeskyFactor factor(scaled, FactorPrecision::Single);
    ASSERT_TRUE(factor.positive());
    EXPECT_EQ(factor.precision(), FactorPrecision::Single);
    const Values b = unit * test::random_values(static_cast<Index>(matrix.rows()), 3);
    Values x;
    factor.solve(b, x);
    const double first = (scaled * x - b).norm();
    EXPECT_LE(first, 1e-5 * b.norm());
    EXPECT_GT(first, 1e-12 * b.norm()) << "as if it were in double precision";
    for (int i = 0; i < 4; ++i) {
      Values step;
      factor.solve(b - scaled * x, step);
      x += step;
    }
    EXPECT_LE((scaled * x - b).norm(), 1e-14 * b.norm());
  }
}

TEST(CholeskyFactor, SinglePrecisionHasTheSameBitsOnAnyNumberOfThreads) {
  const Matrix matrix = grid_matrix(90);
  const Values b = test::random_values(static_cast<Index>(matrix.rows()), 3);
  EXPECT_EQ(solution_on(1, matrix, b, FactorPrecision::Single), solution_on(4, matrix, b, FactorPrecision::Single));
}

/// Blocks so large that threads share one: a full matrix.
TEST(CholeskyFactor, SharesRowsOfLargeBlocks) {
  std::vector<Eigen::Triplet<double>> full;
  for (int i = 0; i < 900; ++i) {
    for (int j = 0; j <= i; ++j) full.emplace_back(i, j, i == j ? 1000.0 : std::cos(3.0 * i + j));
  }
  const Matrix matrix = symmetric(900, full);
  const Values b = test::random_values(900, 3);
  const Values alone = solution_on(1, matrix, b);
  EXPECT_EQ(alone, solution_on(4, matrix, b));
  EXPECT_LE((matrix * alone - b).norm(), 1e-12 * b.norm());
}

TEST(CholeskyFactor, OfNothingSolvesNothing) {
  const CholeskyFactor factor(Matrix(0, 0));
  Values x;
  factor.solve(Values(0, 3), x);
  EXPECT_TRUE(factor.positive());
  EXPECT_EQ(x.rows(), 0);
}

}  // namespace
}  // namespace batten
