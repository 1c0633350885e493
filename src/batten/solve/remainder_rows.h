/// \file The rows of G = E - A where each has weights of its own.
#pragma once
#include "batten/buffer.h"
#include "batten/progress.h"
#include "batten/types.h"

namespace batten {

/// The entries of G by rows, in the order in which they are summed; a column may come several times. A row has entries
/// or none; if it has some, the last one is that on the diagonal, and the only one there.
struct RemainderRows {
  Buffer<std::size_t> offsets;  ///< n+1
  Buffer<Index> columns;
  Buffer<double> weights;

  Index size() const { return static_cast<Index>(offsets.size()) - 1; }

  /// Sets out = G x, both n-by-k, in one sweep over all rows. Throws Error(Cancelled).
  void apply(const Values& x, Values& out, const Progress& progress = {}) const;
};

}  // namespace batten
