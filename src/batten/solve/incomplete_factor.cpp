#include "batten/solve/incomplete_factor.h"

#include <algorithm>
#include <cmath>

#include "batten/error.h"

namespace batten {

namespace {

/// What the scaled diagonal of ones grows by where a pivot is not positive; twice as much each time. Smaller ones save
/// no iterations (docs/decisions/011-fair-solver.md).
constexpr double kShift = 1e-2;
/// Next to a diagonal of this size no entry of a scaled positive definite matrix counts.
constexpr double kMostShift = 1e9;
constexpr double kLeastPivot = 1e-10;

}  // namespace

/// The vertices' own order, in which neighbours stand near each other, is as good as a fill-reducing one where nothing
/// is filled in (docs/decisions/011-fair-solver.md).
IncompleteFactor::IncompleteFactor(const Eigen::SparseMatrix<double, Eigen::RowMajor>& matrix) {
  list_entries(matrix);
  for (double shift = 0.0; !factorise(matrix, shift); shift = std::max(kShift, 2.0 * shift)) {
    if (shift > kMostShift) throw Error(ErrorCode::NotFinite, "the system has numbers that are not finite");
  }
}

/// The lower triangle.
void IncompleteFactor::list_entries(const Eigen::SparseMatrix<double, Eigen::RowMajor>& matrix) {
  const auto count = static_cast<int>(matrix.rows());
  scale_.resize(static_cast<std::size_t>(count));
  starts_.assign(1, 0);
  for (int i = 0; i < count; ++i) {
    for (int e = matrix.outerIndexPtr()[i]; e < matrix.outerIndexPtr()[i + 1]; ++e) {
      const int column = matrix.innerIndexPtr()[e];
      if (column > i) break;
      columns_.push_back(column);
      if (column == i) scale_[i] = 1.0 / std::sqrt(matrix.valuePtr()[e]);
    }
    starts_.push_back(static_cast<int>(columns_.size()));
  }
  weights_.resize(columns_.size());
}

/// Row by row: l_ik = (a_ik - sum over j < k of l_ij l_kj) / l_kk, of the entries that the matrix has. False where a
/// pivot is not positive.
bool IncompleteFactor::factorise(const Eigen::SparseMatrix<double, Eigen::RowMajor>& matrix, double shift) {
  const auto count = static_cast<int>(matrix.rows());
  Buffer<double> row(static_cast<std::size_t>(count), 0.0);
  for (int i = 0; i < count; ++i) {
    const int begin = starts_[i];
    const int last = starts_[i + 1] - 1;
    const double* const given = matrix.valuePtr() + matrix.outerIndexPtr()[i];
    double pivot = 1.0 + shift;
    for (int e = begin; e < last; ++e) {
      const int k = columns_[e];
      double even = given[e - begin] * scale_[i] * scale_[k];
      double odd = 0.0;
      int f = starts_[k];
      const int diagonal = starts_[k + 1] - 1;
      for (; f + 1 < diagonal; f += 2) {
        even -= weights_[f] * row[columns_[f]];
        odd -= weights_[f + 1] * row[columns_[f + 1]];
      }
      if (f < diagonal) even -= weights_[f] * row[columns_[f]];
      const double weight = (even + odd) * weights_[diagonal];
      weights_[e] = weight;
      row[k] = weight;
      pivot -= weight * weight;
    }
    for (int e = begin; e < last; ++e) row[columns_[e]] = 0.0;
    if (!(pivot > kLeastPivot)) return false;
    weights_[last] = 1.0 / std::sqrt(pivot);
  }
  return true;
}

void IncompleteFactor::solve_four(Buffer<Double4>& x) const {
  const auto count = static_cast<int>(x.size());
  for (int i = 0; i < count; ++i) {
    Double4 even = x[i];
    Double4 odd{};
    const int diagonal = starts_[i + 1] - 1;
    int e = starts_[i];
    for (; e + 1 < diagonal; e += 2) {
      even -= weights_[e] * x[columns_[e]];
      odd -= weights_[e + 1] * x[columns_[e + 1]];
    }
    if (e < diagonal) even -= weights_[e] * x[columns_[e]];
    x[i] = (even + odd) * weights_[diagonal];
  }
  for (int i = count - 1; i >= 0; --i) {
    const int diagonal = starts_[i + 1] - 1;
    const Double4 value = x[i] * weights_[diagonal];
    x[i] = value;
    for (int e = starts_[i]; e < diagonal; ++e) x[columns_[e]] -= weights_[e] * value;
  }
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
    solve_four(four);
    for (Eigen::Index i = 0; i < b.rows(); ++i) {
      for (Eigen::Index c = 0; c < columns; ++c) x(i, first + c) = four[i][c] * scale_[i];
    }
  }
}

}  // namespace batten
