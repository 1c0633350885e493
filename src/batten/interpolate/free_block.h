/// \file The free rows of the limit matrix as a linear system, for the solvers.
#pragma once
#include "batten/limit/ring_rows.h"
#include "batten/solve/solver.h"
#include "batten/solve/tiled_iteration.h"

namespace batten {

/// Which rows of a limit matrix are unknowns; the others hold their values.
class FreeBlock : public RowSource {
 public:
  /// free: one flag a vertex, or empty where all rows are unknowns.
  FreeBlock(const LimitMatrix& matrix, Buffer<std::uint8_t> free);

  void row(Index row, RowEntries& entries) const override;
  Index weights_key(Index row) const override { return ring_key(matrix_, row); }
  void columns_of(Index row, Index* columns) const override { ring_columns(matrix_, row, columns); }

  Index free_count() const { return free_count_; }
  /// True when the free rows are symmetric after scaling: smooth rows only.
  bool is_symmetric() const { return symmetric_; }

  /// Conjugate gradients where symmetric, and stabilised bi-conjugate gradients where it is not or turns out to be
  /// indefinite.
  SolveReport solve_krylov(ConstValuesRef targets, Values& x, const StopRule& stop) const;

  /// Sparse Cholesky where symmetric and definite, else LU; one step of iterative refinement. Memory grows with the
  /// fill. Throws Error(SingularSystem).
  SolveReport solve_direct(ConstValuesRef targets, Values& x, const StopRule& stop) const;

 private:
  /// Sets the rows that are not free to zero.
  void mask(Values& values) const;
  LinearMap map() const;

  const LimitMatrix& matrix_;
  Index free_count_ = 0;
  bool symmetric_ = true;
};

}  // namespace batten
