/// \file What a sparse Cholesky factor looks like before its numbers are known: which columns have the same rows.
///
/// A supernode is a range of columns of L whose rows below the range are the same, so that it is stored as a dense
/// block. Each but the roots has a parent: the supernode that its first row below belongs to (after Duff and Reid 1983,
/// key DR83, and Liu 1990, key L90).
#pragma once
#include <Eigen/SparseCore>

#include "batten/buffer.h"

namespace batten {

/// The order of elimination and the supernodes, children before parents. For the pattern of a symmetric matrix of
/// which both triangles are there, its diagonal included. O(entries of L).
class Elimination {
 public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  explicit Elimination(const Matrix& matrix);

  /// Row i of the matrix is row order()[i] of L; the other way is places().
  const Buffer<int>& order() const { return order_; }
  const Buffer<int>& places() const { return places_; }

  int count() const { return static_cast<int>(starts_.size()) - 1; }  ///< of supernodes
  int first_column(int node) const { return starts_[node]; }
  int width(int node) const { return starts_[node + 1] - starts_[node]; }
  /// All rows of a supernode, its own columns first; ascending.
  int row_count(int node) const { return static_cast<int>(row_starts_[node + 1] - row_starts_[node]); }
  const int* rows(int node) const { return rows_.data() + row_starts_[node]; }
  int parent(int node) const { return parents_[node]; }  ///< -1 for a root

 private:
  void order_columns(const Matrix& matrix);
  void merge_columns(const Matrix& matrix);
  void list_rows(const Matrix& matrix);

  Buffer<int> order_;
  Buffer<int> places_;
  Buffer<int> column_parents_;  ///< the elimination tree
  Buffer<int> starts_;          ///< of the supernodes' columns
  Buffer<int> parents_;
  Buffer<std::size_t> row_starts_;
  Buffer<int> rows_;
};

}  // namespace batten
