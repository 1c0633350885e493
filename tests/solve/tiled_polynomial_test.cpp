#include "batten/solve/tiled_polynomial.h"

#include <gtest/gtest.h>

#include <cmath>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "support/values.h"

namespace batten {
namespace {

using test::random_values;

/// A cyclic random walk over an n-by-n torus whose weights change from row to row, but not too much.
class UnevenRows : public RowSource {
 public:
  explicit UnevenRows(Index n) : RowSource(n * n), n_(n) {}
  void row(Index row, RowEntries& entries) const override {
    if (row % 41 == 0) return entries.add(row, 1.0);
    const double side = row % 3 == 0 ? 0.1 : 0.12;
    const Index i = row / n_;
    const Index j = row % n_;
    entries.add(row, 1.0 - 4.0 * side);
    entries.add((i + 1) % n_ * n_ + j, side);
    entries.add((i + n_ - 1) % n_ * n_ + j, side);
    entries.add(i * n_ + (j + 1) % n_, side);
    entries.add(i * n_ + (j + n_ - 1) % n_, side);
  }
  Values remainder(const Values& x) const {
    Values y = x;
    RowEntries entries;
    for (Index r = 0; r < size(); ++r) {
      entries.clear();
      row(r, entries);
      for (std::size_t k = 0; k < entries.columns.size(); ++k)
        y.row(r) -= entries.weights[k] * x.row(entries.columns[k]);
    }
    return y;
  }
  /// The definition, with whole sweeps.
  Values polynomial(const std::vector<double>& coefficients, int passes, Values x) const {
    for (int k = 0; k < passes; ++k) {
      Values power = x;
      Values sum = coefficients[0] * x;
      for (std::size_t i = 1; i < coefficients.size(); ++i) {
        power = remainder(power);
        sum += coefficients[i] * power;
      }
      x = sum;
    }
    return x;
  }

 private:
  Index n_;
};

/// Some thousand unknowns a tile: 130 x 130 make six tiles.
TEST(TiledPolynomial, IsThePolynomialOverTheWholeMesh) {
  const UnevenRows rows(130);
  const TiledPolynomial tiles(rows);
  ASSERT_TRUE(tiles.fits());
  EXPECT_GT(tiles.overlap(), 1.1);
  const Values start = random_values(rows.size(), 3);
  struct Case {
    std::vector<double> coefficients;
    int passes;
  };
  // One round, many rounds, a pass longer than a round, every power at once.
  const std::vector<Case> cases{
      {{1.0, 0.0, 0.0, -1.0}, 4},
      {{0.0, 1.0}, 20},
      {{1.0, -1.0}, 7},
      {{0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0}, 2},
      {{0.5, 1.0, -2.0, 3.0, 0.25, -1.0, 0.7, 0.3, 0.2, 0.1, 1.0, 0.0, 0.0, 0.0, 0.0, 2.0}, 3},
      {{3.0}, 2},
      {{1.0, 1.0}, 0}};
  for (const Case& each : cases) {
    SCOPED_TRACE(each.coefficients.size());
    Values x(start.rows(), start.cols());
    tiles.apply(each.coefficients, each.passes, start, x);
    const Values expected = rows.polynomial(each.coefficients, each.passes, start);
    // A few hundred roundings of sums of at most `largest`.
    EXPECT_LT((x - expected).cwiseAbs().maxCoeff(), 1e-13 * std::max(1.0, expected.cwiseAbs().maxCoeff()));
  }
}

TEST(TiledPolynomial, TakesAnyNumberOfColumnsAndBlocksOfThem) {
  const UnevenRows rows(70);
  const TiledPolynomial tiles(rows);
  const Values start = random_values(rows.size(), 11);
  const std::vector<double> coefficients{1.0, 0.5, -0.25};
  const Values expected = rows.polynomial(coefficients, 3, start);
  Values all(start.rows(), start.cols());
  tiles.apply(coefficients, 3, start, all);
  EXPECT_LT((all - expected).cwiseAbs().maxCoeff(), 1e-13);
  Values some = start;
  tiles.apply(coefficients, 3, start.middleCols(2, 6), some.middleCols(2, 6));
  EXPECT_TRUE((some.middleCols(2, 6).array() == all.middleCols(2, 6).array()).all());
  EXPECT_TRUE((some.leftCols(2).array() == start.leftCols(2).array()).all());
  EXPECT_TRUE((some.rightCols(3).array() == start.rightCols(3).array()).all());
}

TEST(TiledPolynomial, ThreadsDoNotChangeABit) {
  const UnevenRows rows(130);
  const TiledPolynomial tiles(rows);
  const Values start = random_values(rows.size(), 3);
  Values all = start;
  Values one = start;
  tiles.apply({1.0, 0.0, -1.0}, 9, start, all);
  const ThreadLimit limit(1);
  TiledPolynomial(rows).apply({1.0, 0.0, -1.0}, 9, start, one);
  EXPECT_TRUE((all.array() == one.array()).all());
}

/// G of a torus whose every entry differs; some rows have no entries, some only that on the diagonal.
RemainderRows own_rows(Index n) {
  RemainderRows rows;
  rows.offsets.push_back(0);
  for (Index row = 0; row < n * n; ++row) {
    const Index i = row / n;
    const Index j = row % n;
    if (row % 41 != 0) {
      const Index neighbours[] = {(i + 1) % n * n + j, (i + n - 1) % n * n + j, i * n + (j + 1) % n,
                                  i * n + (j + n - 1) % n};
      for (int k = 0; k < 4 && row % 43 != 0; ++k) {
        rows.columns.push_back(neighbours[k]);
        rows.weights.push_back(-0.1 - 0.02 * std::sin(row + 0.3 * k));
      }
      rows.columns.push_back(row);
      rows.weights.push_back(0.4 + 0.1 * std::cos(row));
    }
    rows.offsets.push_back(rows.columns.size());
  }
  return rows;
}

/// The oracle is the definition, with whole sweeps.
TEST(TiledPolynomial, TakesRowsWithWeightsOfTheirOwn) {
  const RemainderRows rows = own_rows(130);
  const TiledPolynomial tiles(rows);
  ASSERT_TRUE(tiles.fits());
  for (const Index columns : {1, 3, 6}) {
    const Values start = random_values(rows.size(), columns);
    Values expected = start;
    const std::vector<double> coefficients{0.3, -1.0, 0.0, 2.0};
    for (int pass = 0; pass < 5; ++pass) {
      Values power = expected;
      Values next;
      expected *= coefficients[0];
      for (std::size_t i = 1; i < coefficients.size(); ++i) {
        rows.apply(power, next);
        power = next;
        expected += coefficients[i] * power;
      }
    }
    Values result(start.rows(), start.cols());
    tiles.apply(coefficients, 5, start, result);
    EXPECT_LT((result - expected).cwiseAbs().maxCoeff(), 1e-14 * expected.cwiseAbs().maxCoeff()) << columns;
    Values again(start.rows(), start.cols());
    const ThreadLimit limit(1);
    TiledPolynomial(rows).apply(coefficients, 5, start, again);
    EXPECT_TRUE((again.array() == result.array()).all());
  }
}

TEST(TiledPolynomial, RefusesWhatDoesNotFit) {
  const UnevenRows rows(10);
  const TiledPolynomial tiles(rows);
  const Values few = random_values(99, 1);
  const Values right = random_values(100, 1);
  Values result = right;
  EXPECT_THROW(tiles.apply({1.0, -1.0}, 1, few, result), Error);
  EXPECT_THROW(tiles.apply({}, 1, right, result), Error);
  Values wide(100, 2);
  EXPECT_THROW(tiles.apply({1.0, -1.0}, 1, right, wide), Error);
}

TEST(TiledPolynomial, ACancelledCallEnds) {
  const UnevenRows rows(130);
  const TiledPolynomial tiles(rows);
  const Values start = random_values(rows.size(), 3);
  Values x = start;
  int calls = 0;
  EXPECT_THROW(tiles.apply({1.0, -1.0}, 30, start, x, [&](double) { return ++calls < 4; }), Error);
  EXPECT_EQ(calls, 4);
}

}  // namespace
}  // namespace batten
