/// \file An incomplete Cholesky factor as a preconditioner of several columns at once.
#pragma once
#include <Eigen/SparseCore>
#include <vector>

#include "batten/buffer.h"
#include "batten/double4.h"
#include "batten/parallel/spare.h"
#include "batten/types.h"

namespace batten {

/// L L^T near a sparse symmetric positive definite matrix: L has entries only where the matrix has, and there L L^T is
/// the matrix (key S03, 10.3.2). Where that meets a pivot that is not positive, it adds to the diagonal of the matrix
/// scaled to a diagonal of ones (after Lin and More 1999, key LM99).
///
/// A long matrix whose entries stand in a band is cut into up to 8 parts that have no entry in common; the few rows
/// between two parts come after both. The parts share the threads, then the rows between them do. The cut depends on
/// the matrix alone, and so do all bits. Rows that stand beside each other in a mesh should stand near each other here.
/// Safe from several threads. Build some 20 nanoseconds an entry of L where a row has 28 of them.
class IncompleteFactor {
 public:
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

  /// Shorter parts are not worth a second thread.
  static constexpr int kLeastRows = 2048;

  /// Both triangles of the matrix are there, columns ascending. Diagonals are positive. least_rows: of a part, at least
  /// 1. Throws Error(NotFinite).
  explicit IncompleteFactor(const Matrix& matrix, int least_rows = kLeastRows);

  /// x = (L L^T)^-1 b, N-by-k each.
  void solve(const Values& b, Values& x) const;

  int part_count() const { return static_cast<int>(parts_.size()); }

 private:
  /// Rows of L.
  struct Range {
    int begin;
    int end;
  };

  void cut(const Matrix& matrix, int least_rows);
  void count_entries(const Matrix& matrix);
  template <typename Visit>
  void visit_row(const Matrix& matrix, const Range& range, int row, const Visit& visit) const;
  void copy_entries(const Matrix& matrix, const Range& range, int right);
  bool factorise(const Matrix& matrix, double shift);
  bool factorise(double shift, const Range& range);
  void eliminate(const Range& range, Buffer<Double4>& x) const;
  void substitute_part(int part, Buffer<Double4>& x) const;
  void substitute_between(const Range& range, Buffer<Double4>& x) const;
  void take_from_part(const Range& between, bool is_left, Buffer<Double4>& x) const;
  int between_begin() const { return parts_.back().end; }
  /// Where among the entries of a row between two parts those of the right part begin, and those of its own kind.
  const int* bounds(int row) const { return bounds_.data() + 2 * static_cast<std::size_t>(row - between_begin()); }

  std::vector<Range> parts_;
  std::vector<Range> between_;  ///< number j stands between parts j and j + 1, after all parts
  Buffer<int> places_;          ///< of each row of the matrix
  Buffer<int> rows_;            ///< of the matrix, of each place
  Buffer<int> starts_;          ///< of the rows of L, the diagonal last
  Buffer<int> bounds_;
  Buffer<int> columns_;
  Buffer<double> weights_;  ///< on the diagonal one over L's number
  Buffer<double> scale_;    ///< of each row of L: a row and its column times this: diagonals of 1
  mutable Spare<Buffer<Double4>> spare_;
};

}  // namespace batten
