/// Sparse matrices times points.
#include "batten/solve/sparse_product.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <limits>

#include "batten/types.h"

namespace batten {
namespace {

constexpr int kColumns = 7;

/// A row for each set of columns: every number of entries, and the last column at odd and even places.
Eigen::SparseMatrix<double, Eigen::RowMajor> all_rows() {
  constexpr int kRows = 1 << kColumns;
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(kRows, kColumns);
  for (int r = 0; r < kRows; ++r)
    for (int c = 0; c < kColumns; ++c)
      if ((r >> c) % 2 == 1) dense(r, c) = 1.0 + 0.1 * c + 0.01 * r;
  return dense.sparseView();
}

Values seven_points() {
  Values points(kColumns, 3);
  for (int i = 0; i < points.size(); ++i) points.data()[i] = i % 2 == 0 ? 1.0 + i : -0.5 * i;
  return points;
}

TEST(SparseProduct, IsTheDenseProduct) {
  const auto matrix = all_rows();
  const Values points = seven_points();
  Values result;
  multiply(matrix, points, result);
  const Values expected = Eigen::MatrixXd(matrix) * points;
  EXPECT_LE((result - expected).cwiseAbs().maxCoeff(), 1e-13);  // rounding of sums up to 200
}

TEST(SparseProduct, TakesNothingFromARowBesideThoseThatCount) {
  const auto matrix = all_rows();
  for (int row = 0; row < kColumns; ++row) {
    Values points = seven_points();
    points.row(row).setConstant(std::numeric_limits<double>::quiet_NaN());
    Values result;
    multiply(matrix, points, result);
    for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
      EXPECT_EQ(result.row(r).array().isFinite().all(), (r >> row) % 2 == 0) << row << " " << r;
    }
  }
}

}  // namespace
}  // namespace batten
