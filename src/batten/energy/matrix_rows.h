/// \file Sparse matrices made row by row from sums of many small rows.
#pragma once
#include <Eigen/SparseCore>
#include <algorithm>
#include <limits>
#include <memory>
#include <mutex>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "batten/buffer.h"
#include "batten/error.h"
#include "batten/parallel/parallel.h"

namespace batten {

using EnergyMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// One row at a time: adds up entries of the same column.
class RowSum {
 public:
  explicit RowSum(Index columns) : places_(static_cast<std::size_t>(columns), kNone) {}

  /// Adds weight(j) at columns[j], for each j.
  template <typename Weight>
  void add(std::span<const Index> columns, const Weight& weight) {
    if (columns_.size() < count_ + columns.size()) {
      columns_.resize(2 * (count_ + columns.size()));
      values_.resize(columns_.size());
    }
    for (std::size_t j = 0; j < columns.size(); ++j) {
      Index& place = places_[columns[j]];
      if (place == kNone) {
        place = static_cast<Index>(count_);
        columns_[count_] = columns[j];
        values_[count_++] = weight(static_cast<Index>(j));
      } else {
        values_[place] += weight(static_cast<Index>(j));
      }
    }
  }

  std::size_t size() const { return count_; }

  /// Calls visit(column, value), columns ascending, and forgets the row.
  template <typename Visit>
  void take(const Visit& visit) {
    std::sort(columns_.begin(), columns_.begin() + static_cast<std::ptrdiff_t>(count_));
    for (std::size_t i = 0; i < count_; ++i) {
      visit(columns_[i], values_[places_[columns_[i]]]);
      places_[columns_[i]] = kNone;
    }
    count_ = 0;
  }

 private:
  static constexpr Index kNone = -1;
  Buffer<Index> places_;   ///< of each column among those of the row, or kNone
  Buffer<Index> columns_;  ///< in the order in which they came
  Buffer<double> values_;
  std::size_t count_ = 0;
};

/// Scratch objects that threads take and give back, so that there are as many as threads.
template <typename Scratch>
class ScratchPool {
 public:
  template <typename Make>
  std::unique_ptr<Scratch> take(const Make& make) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!free_.empty()) {
        std::unique_ptr<Scratch> scratch = std::move(free_.back());
        free_.pop_back();
        return scratch;
      }
    }
    return make();
  }
  void give_back(std::unique_ptr<Scratch> scratch) {
    const std::lock_guard<std::mutex> lock(mutex_);
    free_.push_back(std::move(scratch));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Scratch>> free_;
};

/// The matrix whose row r is what fill(r, scratch) has added to scratch.row. make() returns a new scratch. Threaded,
/// the same bits for any number of threads. Memory: twice the matrix. Throws Error(TooLarge), Error(Cancelled).
template <typename Scratch, typename Make, typename Fill>
EnergyMatrix matrix_of_rows(Index rows, Index columns, const Make& make, const Fill& fill, const Progress& progress) {
  constexpr std::ptrdiff_t kBlock = 512;
  struct Block {
    Buffer<int> columns;
    Buffer<double> values;
  };
  std::vector<Block> blocks(static_cast<std::size_t>(block_count(rows, kBlock)));
  Buffer<std::size_t> starts(static_cast<std::size_t>(rows) + 1, 0);
  ScratchPool<Scratch> pool;
  parallel_for(
      rows,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        std::unique_ptr<Scratch> scratch = pool.take(make);
        Block& block = blocks[begin / kBlock];
        for (auto r = static_cast<Index>(begin); r < static_cast<Index>(end); ++r) {
          fill(r, *scratch);
          starts[r + 1] = scratch->row.size();
          scratch->row.take([&](Index column, double value) {
            block.columns.push_back(column);
            block.values.push_back(value);
          });
        }
        pool.give_back(std::move(scratch));
      },
      kBlock, progress);
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  if (starts.back() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw Error(ErrorCode::TooLarge, "the matrix has " + std::to_string(starts.back()) +
                                         " entries, more than 2^31 - 1; use SurfaceEnergy::apply instead");
  }
  EnergyMatrix matrix(rows, columns);
  matrix.resizeNonZeros(static_cast<Eigen::Index>(starts.back()));
  for (Index r = 0; r <= rows; ++r) matrix.outerIndexPtr()[r] = static_cast<int>(starts[r]);
  parallel_for(
      rows,
      [&](std::ptrdiff_t begin, std::ptrdiff_t /*end*/) {
        Block& block = blocks[begin / kBlock];
        std::copy(block.columns.begin(), block.columns.end(), matrix.innerIndexPtr() + starts[begin]);
        std::copy(block.values.begin(), block.values.end(), matrix.valuePtr() + starts[begin]);
        block = Block();
      },
      kBlock);
  return matrix;
}

}  // namespace batten
