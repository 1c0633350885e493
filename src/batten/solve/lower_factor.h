/// \file Forward and back substitution with a sparse lower triangle, four columns at once.
#pragma once
#include "batten/buffer.h"
#include "batten/double4.h"

namespace batten {

/// A lower triangle by columns, the diagonal first in each.
struct LowerFactor {
  Buffer<int> starts;  ///< columns + 1
  Buffer<int> rows;
  Buffer<double> weights;

  /// x = (L L^T)^-1 x.
  void solve(Buffer<Double4>& x) const;
};

}  // namespace batten
