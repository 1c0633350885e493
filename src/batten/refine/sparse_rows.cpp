#include "batten/refine/sparse_rows.h"

#include <algorithm>

namespace batten {

namespace {

/// Rows are mostly short, and std::stable_sort asks for memory each time.
void sort_by_vertex(VertexWeights& row) {
  constexpr std::size_t kShort = 32;
  if (row.size() > kShort) {
    std::stable_sort(row.begin(), row.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    return;
  }
  for (std::size_t i = 1; i < row.size(); ++i) {
    const auto moved = row[i];
    std::size_t hole = i;
    for (; hole > 0 && moved.first < row[hole - 1].first; --hole) row[hole] = row[hole - 1];
    row[hole] = moved;
  }
}

}  // namespace

void merge(VertexWeights& row) {
  sort_by_vertex(row);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (kept > 0 && row[kept - 1].first == row[i].first) {
      row[kept - 1].second += row[i].second;
    } else {
      row[kept++] = row[i];
    }
  }
  row.resize(kept);
}

SparseRows identity_rows(Index count) {
  SparseRows rows;
  for (Index i = 0; i < count; ++i) {
    rows.add(i, 1.0);
    rows.end_row();
  }
  return rows;
}

SparseRows product(const SparseRows& left, const SparseRows& right, Index columns) {
  SparseRows result;
  Buffer<double> sums(static_cast<std::size_t>(columns), 0.0);
  Buffer<std::uint8_t> met(static_cast<std::size_t>(columns), 0);
  Buffer<Index> of_row;
  for (Index r = 0; r < left.count(); ++r) {
    of_row.clear();
    for (Index e = left.starts[r]; e < left.starts[r + 1]; ++e) {
      const Index row = left.columns[e];
      for (Index k = right.starts[row]; k < right.starts[row + 1]; ++k) {
        const Index column = right.columns[k];
        if (met[column] == 0) of_row.push_back(column);
        met[column] = 1;
        sums[column] += left.weights[e] * right.weights[k];
      }
    }
    std::sort(of_row.begin(), of_row.end());
    for (const Index column : of_row) {
      if (sums[column] != 0.0) result.add(column, sums[column]);
      sums[column] = 0.0;
      met[column] = 0;
    }
    result.end_row();
  }
  return result;
}

}  // namespace batten
