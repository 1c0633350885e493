/// \file A sparse Cholesky factor for several columns at once.
#pragma once
#include <Eigen/SparseCore>

#include "batten/buffer.h"
#include "batten/solve/lower_factor.h"
#include "batten/types.h"

namespace batten {

/// L L^T = P A P^T of a sparse symmetric positive definite matrix, with an order P that keeps L sparse (approximate
/// minimum degree; Eigen::SimplicialLLT). Const calls are safe from several threads; serial. For the stiffness of n
/// control points on quads L has some 25 log2(n) entries a row, of 12 bytes.
class CholeskyFactor {
 public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  /// Both triangles of the matrix are there.
  explicit CholeskyFactor(const Matrix& matrix);

  /// False where a pivot was not positive: the matrix is not positive definite, and solve() must not be called.
  bool positive() const { return positive_; }
  /// The least pivot, relative to the matrix's own diagonal there: about 1e-16 where the matrix is singular.
  double least_pivot() const { return least_pivot_; }
  std::size_t entry_count() const { return lower_.rows.size(); }

  /// x = A^-1 b, N-by-k each.
  void solve(const Values& b, Values& x) const;

 private:
  Buffer<int> order_;  ///< row i of A is row order_[i] of L
  LowerFactor lower_;
  bool positive_ = false;
  double least_pivot_ = 0.0;
};

}  // namespace batten
