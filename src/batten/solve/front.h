/// \file Dense Cholesky factors of the first columns of a matrix, and what they leave of the others.
#pragma once
#include <cstddef>

#include "batten/buffer.h"

namespace batten {

/// A symmetric matrix by columns, of which the lower triangle counts.
struct Front {
  int size = 0;
  Buffer<double> entries;  ///< size^2

  double* column(int j) { return entries.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(size); }
  const double* column(int j) const {
    return entries.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(size);
  }
  void reset(int new_size);
};

/// The first `width` columns become those of L, with L L^T = the matrix; the others lose what these take from them:
/// the Schur complement. Threaded where it is large, the same bits for any number of threads. Returns the least ratio
/// of a pivot to the diagonal's entry in `diagonal`, or a negative number where a pivot is not positive.
double factor_front(Front& front, int width, const double* diagonal);

}  // namespace batten
