/// \file A matrix of few numbers a row, and its products with points and with another.
#pragma once
#include <utility>
#include <vector>

#include "batten/buffer.h"
#include "batten/types.h"

namespace batten {

/// Row r has the entries starts[r] .. starts[r + 1] of `columns` and `weights`.
struct SparseRows {
  Buffer<Index> starts{0};  ///< rows + 1
  Buffer<Index> columns;
  Buffer<double> weights;

  Index count() const { return static_cast<Index>(starts.size()) - 1; }
  /// Appends an entry to the row that end_row() will end.
  void add(Index column, double weight) {
    columns.push_back(column);
    weights.push_back(weight);
  }
  void end_row() { starts.push_back(static_cast<Index>(columns.size())); }
};

/// One row by itself: vertices and their weights.
using VertexWeights = std::vector<std::pair<Index, double>>;

/// Sorts by vertex and adds up the weights of each, in the order in which they stand. Zeros stay.
void merge(VertexWeights& row);

/// The sum of weight * points[column] over a row. Point is a number or a vector of numbers that starts as zero. Two
/// sums take turns, so that the processor need not wait for one addition before the next.
template <typename Point>
Point combine(const SparseRows& rows, Index row, const Point* points) {
  Point even{};
  Point odd{};
  Index e = rows.starts[row];
  const Index end = rows.starts[row + 1];
  for (; e + 1 < end; e += 2) {
    even += rows.weights[e] * points[rows.columns[e]];
    odd += rows.weights[e + 1] * points[rows.columns[e + 1]];
  }
  if (e < end) even += rows.weights[e] * points[rows.columns[e]];
  return even + odd;
}

/// n rows of a single 1 each, on the diagonal.
SparseRows identity_rows(Index count);

/// The matrix product; `right` has `columns` columns. Columns of a row ascend, each stands once, and zeros are left
/// out. O(multiplications), and O(columns) of memory.
SparseRows product(const SparseRows& left, const SparseRows& right, Index columns);

}  // namespace batten
