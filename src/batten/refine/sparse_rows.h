/// \file A sparse matrix stored by rows, and its products with points and with another matrix.
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
  /// Appends an entry to the current row, which end_row() ends.
  void add(Index column, double weight) {
    columns.push_back(column);
    weights.push_back(weight);
  }
  void end_row() { starts.push_back(static_cast<Index>(columns.size())); }
};

/// A single row: vertices and their weights.
using VertexWeights = std::vector<std::pair<Index, double>>;

/// Sorts the row by vertex and adds the weights of each vertex in the row's order. Zeros are kept.
void merge(VertexWeights& row);

/// The sum of weight * points[column] over a row. Point is a number, or a vector of numbers that is zero by default.
/// Two alternating sums let the processor start an addition before the previous one has ended.
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

/// The identity matrix with `count` rows.
SparseRows identity_rows(Index count);

/// The matrix product; `right` has `columns` columns. The columns of each row ascend, none is repeated, and zeros are
/// left out. O(multiplications) time, O(columns) extra memory.
SparseRows product(const SparseRows& left, const SparseRows& right, Index columns);

}  // namespace batten
