#include "batten/refine/sparse_rows.h"

#include <gtest/gtest.h>

#include <random>

namespace batten {
namespace {

Values dense(const SparseRows& rows, Index columns) {
  Values matrix = Values::Zero(rows.count(), columns);
  for (Index r = 0; r < rows.count(); ++r) {
    for (Index e = rows.starts[r]; e < rows.starts[r + 1]; ++e) matrix(r, rows.columns[e]) += rows.weights[e];
  }
  return matrix;
}

/// Small integers, so that all sums are exact.
SparseRows random_rows(Index count, Index columns, unsigned seed) {
  std::mt19937 random(seed);
  SparseRows rows;
  for (Index r = 0; r < count; ++r) {
    for (unsigned e = random() % 6; e > 0; --e) {
      rows.add(static_cast<Index>(random() % static_cast<unsigned>(columns)), static_cast<double>(random() % 9) - 4.0);
    }
    rows.end_row();
  }
  return rows;
}

TEST(SparseRows, CombineIsTheDenseProduct) {
  const SparseRows rows = random_rows(40, 7, 1);
  Scalars points(7);
  points << 3, -1, 4, 1, -5, 9, 2;
  const Scalars expected = dense(rows, 7) * points;
  for (Index r = 0; r < rows.count(); ++r) EXPECT_EQ(combine(rows, r, points.data()), expected[r]) << r;
}

/// 1e16 + 1 is 1e16 in doubles, so the sum tells in which order it was formed.
TEST(SparseRows, MergingAddsInTheOrderOfTheRowHoweverLong) {
  for (const Index count : {2, 10, 11, 40}) {
    VertexWeights row;
    for (const double weight : {1e16, 1.0, -1e16}) {
      for (Index v = count; v > 0; --v) row.emplace_back(v * 7 % 41, v % 2 == 0 ? weight : 1.0);
    }
    merge(row);
    ASSERT_EQ(row.size(), static_cast<std::size_t>(count));
    for (std::size_t i = 1; i < row.size(); ++i) EXPECT_LT(row[i - 1].first, row[i].first);
    double sum = 0.0;
    for (const auto& [vertex, weight] : row) sum += weight;
    EXPECT_EQ(sum, 3.0 * static_cast<double>((count + 1) / 2)) << count;
  }
}

TEST(SparseRows, ProductIsTheDenseProduct) {
  const SparseRows left = random_rows(50, 12, 2);
  const SparseRows right = random_rows(12, 9, 3);
  const SparseRows both = product(left, right, 9);
  EXPECT_EQ(dense(both, 9), dense(left, 12) * dense(right, 9));
}

TEST(SparseRows, ProductsHaveAscendingColumnsWithoutZeros) {
  const SparseRows both = product(random_rows(50, 12, 4), random_rows(12, 9, 5), 9);
  for (Index r = 0; r < both.count(); ++r) {
    for (Index e = both.starts[r]; e < both.starts[r + 1]; ++e) {
      EXPECT_NE(both.weights[e], 0.0);
      if (e > both.starts[r]) {
        EXPECT_LT(both.columns[e - 1], both.columns[e]);
      }
    }
  }
}

TEST(SparseRows, IdentityRowsChangeNothing) {
  const SparseRows rows = product(random_rows(20, 8, 6), identity_rows(8), 8);
  EXPECT_EQ(dense(product(identity_rows(20), rows, 8), 8), dense(rows, 8));
}

}  // namespace
}  // namespace batten
