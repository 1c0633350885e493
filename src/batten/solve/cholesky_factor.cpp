#include "batten/solve/cholesky_factor.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

namespace batten {

CholeskyFactor::CholeskyFactor(const Matrix& matrix) {
  using Columns = Eigen::SparseMatrix<double>;
  const Eigen::Map<const Columns> columns(matrix.rows(), matrix.cols(), matrix.nonZeros(), matrix.outerIndexPtr(),
                                          matrix.innerIndexPtr(), matrix.valuePtr());  // equal to its rows
  const Eigen::SimplicialLLT<Columns, Eigen::Lower, Eigen::AMDOrdering<int>> factor(columns);
  if (factor.info() != Eigen::Success) return;
  positive_ = true;
  const Columns& lower = factor.matrixL().nestedExpression();
  lower_.starts.assign(lower.outerIndexPtr(), lower.outerIndexPtr() + lower.cols() + 1);
  lower_.rows.assign(lower.innerIndexPtr(), lower.innerIndexPtr() + lower_.starts.back());
  lower_.weights.assign(lower.valuePtr(), lower.valuePtr() + lower_.starts.back());
  const auto& order = factor.permutationP().indices();
  order_.assign(order.data(), order.data() + order.size());
  least_pivot_ = 1.0;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    const double pivot = lower_.weights[lower_.starts[order_[i]]];
    least_pivot_ = std::min(least_pivot_, pivot * pivot / matrix.coeff(i, i));
  }
}

void CholeskyFactor::solve(const Values& b, Values& x) const {
  x.resize(b.rows(), b.cols());
  Buffer<Double4> four(static_cast<std::size_t>(b.rows()));
  for (Eigen::Index first = 0; first < b.cols(); first += 4) {
    const Eigen::Index columns = std::min<Eigen::Index>(4, b.cols() - first);
    for (Eigen::Index i = 0; i < b.rows(); ++i) {
      Double4 row{};
      for (Eigen::Index c = 0; c < columns; ++c) row[c] = b(i, first + c);
      four[order_[i]] = row;
    }
    lower_.solve(four);
    for (Eigen::Index i = 0; i < b.rows(); ++i) {
      for (Eigen::Index c = 0; c < columns; ++c) x(i, first + c) = four[order_[i]][c];
    }
  }
}

}  // namespace batten
