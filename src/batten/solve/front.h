/// \file Dense Cholesky factors of the first columns of a matrix, and what they leave of the others.
#pragma once
#include <cstddef>

#include "batten/buffer.h"

namespace batten {

/// The lower triangle of a symmetric matrix, column after column from the diagonal down. Number: double or float.
template <typename Number>
struct Front {
  int size = 0;
  Buffer<Number> entries;  ///< entry_count(size, size)

  /// Entries of the first `width` columns of `size` rows.
  static std::size_t entry_count(int size, int width) {
    const auto columns = static_cast<std::size_t>(width);
    return columns * static_cast<std::size_t>(size) - columns * (columns - 1) / 2;  // of no columns 0
  }
  /// Row i of a column stands at its [i], for i >= j.
  Number* column(int j) { return entries.data() + offset(j); }
  const Number* column(int j) const { return entries.data() + offset(j); }
  void reset(int new_size);

 private:
  std::ptrdiff_t offset(int j) const {
    return static_cast<std::ptrdiff_t>(entry_count(size, j)) - static_cast<std::ptrdiff_t>(j);
  }
};

/// The first `width` columns become those of L, with L L^T = the matrix; the others lose what these take from them:
/// the Schur complement. Threaded where it is large, the same bits for any number of threads. Returns the least ratio
/// of a pivot to the diagonal's entry in `diagonal`, or a negative number where a pivot is not positive.
template <typename Number>
double factor_front(Front<Number>& front, int width, const Number* diagonal);

}  // namespace batten
