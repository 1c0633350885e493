/// \file A sparse Cholesky factor for several columns at once.
#pragma once
#include <Eigen/SparseCore>
#include <vector>

#include "batten/buffer.h"
#include "batten/double4.h"
#include "batten/solve/elimination.h"
#include "batten/types.h"

namespace batten {

/// L L^T = P A P^T of a sparse symmetric positive definite matrix, with an order P that keeps L sparse (approximate
/// minimum degree, Amestoy, Davis and Duff 1996, key ADD96, as Eigen has it). Built front by front (multifrontal, Duff
/// and Reid 1983, key DR83), with dense blocks. Const calls are safe from several threads; the same bits for any
/// number of threads, which share independent parts of the factor. For the stiffness of n control points on quads L has
/// some 25 log2(n) entries a row, of 8 bytes; while it is built, up to as much again.
class CholeskyFactor {
 public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  /// Both triangles of the matrix are there, and its whole diagonal.
  explicit CholeskyFactor(const Matrix& matrix);

  /// False where a pivot was not positive: the matrix is not positive definite, and solve() must not be called.
  bool positive() const { return positive_; }
  /// The least pivot, relative to the matrix's own diagonal there: about 1e-16 where the matrix is singular.
  double least_pivot() const { return least_pivot_; }
  std::size_t entry_count() const { return entries_.size(); }

  /// x = A^-1 b, N-by-k each.
  void solve(const Values& b, Values& x) const;

 private:
  /// Supernodes [first, root] that are a whole subtree, and their updates of rows beyond it: those below the root.
  struct Subtree {
    int first;
    int root;
  };

  void split_tree();
  void list_places();
  void factor(const Matrix& matrix);
  void solve_four(Buffer<Double4>& x) const;
  const double* column(int node, int j) const {
    return entries_.data() + starts_[node] +
           static_cast<std::size_t>(j) * static_cast<std::size_t>(elimination_.row_count(node));
  }
  void eliminate(int node, Buffer<Double4>& x, Buffer<Double4>& below) const;
  void substitute(int node, Buffer<Double4>& x, Buffer<Double4>& below) const;

  Elimination elimination_;
  std::vector<Subtree> subtrees_;  ///< independent of each other
  Buffer<int> top_;                ///< the supernodes above them, ascending
  Buffer<int> inside_;             ///< how many of each supernode's rows lie in its subtree
  Buffer<std::size_t> place_starts_;
  Buffer<int> places_;          ///< of the other rows among those below the subtree's root
  Buffer<std::size_t> starts_;  ///< of each supernode's columns of L, from its first row down
  Buffer<double> entries_;
  bool positive_ = false;
  double least_pivot_ = 0.0;
};

}  // namespace batten
