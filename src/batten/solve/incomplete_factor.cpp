#include "batten/solve/incomplete_factor.h"

#include <Eigen/IterativeLinearSolvers>
#include <algorithm>

namespace batten {

namespace {

/// What the scaled diagonal grows by where a pivot is not positive. Smaller ones take longer to build and save no
/// iterations; far smaller ones make the factor useless.
constexpr double kShift = 1e-2;

}  // namespace

IncompleteFactor::IncompleteFactor(const Eigen::SparseMatrix<double, Eigen::RowMajor>& matrix) {
  // The vertices' own order, in which neighbours stand near each other, is as good as a fill-reducing one where nothing
  // is filled in (docs/decisions/011-fair-solver.md).
  using Factor = Eigen::IncompleteCholesky<double, Eigen::Lower, Eigen::NaturalOrdering<int>>;
  const Eigen::Map<const Eigen::SparseMatrix<double>> columns(matrix.rows(), matrix.cols(), matrix.nonZeros(),
                                                              matrix.outerIndexPtr(), matrix.innerIndexPtr(),
                                                              matrix.valuePtr());  // equal to its rows
  Factor factor;
  factor.setInitialShift(kShift);
  factor.compute(columns);
  const auto& lower = factor.matrixL();
  lower_.starts.assign(lower.outerIndexPtr(), lower.outerIndexPtr() + lower.cols() + 1);
  lower_.rows.assign(lower.innerIndexPtr(), lower.innerIndexPtr() + lower_.starts.back());
  lower_.weights.assign(lower.valuePtr(), lower.valuePtr() + lower_.starts.back());
  scale_.assign(factor.scalingS().data(), factor.scalingS().data() + factor.scalingS().size());
}

void IncompleteFactor::solve(const Values& b, Values& x) const {
  x.resize(b.rows(), b.cols());
  Buffer<Double4> four(static_cast<std::size_t>(b.rows()));
  for (Eigen::Index first = 0; first < b.cols(); first += 4) {
    const Eigen::Index columns = std::min<Eigen::Index>(4, b.cols() - first);
    for (Eigen::Index i = 0; i < b.rows(); ++i) {
      Double4 row{};
      for (Eigen::Index c = 0; c < columns; ++c) row[c] = b(i, first + c) * scale_[i];
      four[i] = row;
    }
    lower_.solve(four);
    for (Eigen::Index i = 0; i < b.rows(); ++i) {
      for (Eigen::Index c = 0; c < columns; ++c) x(i, first + c) = four[i][c] * scale_[i];
    }
  }
}

}  // namespace batten
