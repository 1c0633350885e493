/// \file Sparse matrices made row by row from sums of many small rows.
#pragma once
#include <Eigen/SparseCore>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>
#if defined(__linux__)
#include <sys/mman.h>
#endif

#include "batten/buffer.h"
#include "batten/energy/row_sum.h"
#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/progress.h"

namespace batten {

using EnergyMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

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

/// Where the numbers of sparse rows go; no values where only the columns are wanted.
struct RowsPlace {
  int* columns;
  double* values;
};

/// Rows that fill(r, scratch) has added to scratch.row. make() returns a new scratch. starts: where the rows begin, and
/// the end of the last. grow(count, guess) makes room for `count` entries, of about `guess` in the end, and keeps those
/// that are there. Threaded, the same bits for any number of threads. Memory besides the rows: those of some 16,000.
/// Throws Error(TooLarge), Error(Cancelled).
template <typename Scratch, typename Make, typename Fill, typename Grow>
void collect_rows(Index rows, const Make& make, const Fill& fill, bool with_values, Buffer<std::size_t>& starts,
                  const Grow& grow, const Progress& progress) {
  constexpr std::ptrdiff_t kBlock = 512;
  constexpr Index kRowsAtOnce = 32 * kBlock;
  struct Block {
    Buffer<int> columns;
    Buffer<double> values;
  };
  std::vector<Block> blocks(static_cast<std::size_t>(block_count(std::min(rows, kRowsAtOnce), kBlock)));
  starts.assign(static_cast<std::size_t>(rows) + 1, 0);
  ScratchPool<Scratch> pool;
  for (Index first = 0; first < rows; first += kRowsAtOnce) {
    const Index last = std::min(rows, first + kRowsAtOnce);
    parallel_for(
        last - first,
        [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          std::unique_ptr<Scratch> scratch = pool.take(make);
          Block& block = blocks[begin / kBlock];
          block.columns.clear();
          block.values.clear();
          for (Index r = first + static_cast<Index>(begin); r < first + static_cast<Index>(end); ++r) {
            fill(r, *scratch);
            starts[r + 1] = scratch->row.size();
            scratch->row.take([&](Index column, double value) {
              block.columns.push_back(column);
              if (with_values) block.values.push_back(value);
            });
          }
          pool.give_back(std::move(scratch));
        },
        kBlock, progress_within(progress, static_cast<double>(first) / rows, static_cast<double>(last) / rows));
    for (Index r = first; r < last; ++r) starts[r + 1] += starts[r];
    const std::size_t count = starts[last];
    if (count > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
      throw Error(ErrorCode::TooLarge, "the matrix has " + std::to_string(count) +
                                           " entries or more, beyond 2^31 - 1; use SurfaceEnergy::apply instead");
    }
    const RowsPlace place = grow(count, static_cast<std::size_t>(1.05 * static_cast<double>(count) / last * rows));
    parallel_for(
        last - first,
        [&](std::ptrdiff_t begin, std::ptrdiff_t /*end*/) {
          const Block& block = blocks[begin / kBlock];
          const std::size_t start = starts[first + begin];
          std::copy(block.columns.begin(), block.columns.end(), place.columns + start);
          if (with_values) std::copy(block.values.begin(), block.values.end(), place.values + start);
        },
        kBlock);
  }
}

/// Advises the system to use huge pages for an array that is not a Buffer, before it is written for the first time.
inline void advise_huge_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__)
  constexpr std::size_t kPage = 4096;
  if (bytes < std::size_t{1} << 22) return;
  const std::size_t skipped = kPage - reinterpret_cast<std::uintptr_t>(memory) % kPage;
  madvise(static_cast<char*>(memory) + skipped, bytes - skipped, MADV_HUGEPAGE);
#endif
}

/// Makes room for so many entries.
inline void resize_entries(std::size_t count, EnergyMatrix& matrix) {
  const bool is_fresh = matrix.data().allocatedSize() < static_cast<Eigen::Index>(count);
  matrix.resizeNonZeros(static_cast<Eigen::Index>(count));
  if (!is_fresh) return;
  advise_huge_pages(matrix.valuePtr(), count * sizeof(double));
  advise_huge_pages(matrix.innerIndexPtr(), count * sizeof(int));
}

/// Gives a matrix the beginnings of its rows.
inline void set_starts(const Buffer<std::size_t>& starts, EnergyMatrix& matrix) {
  resize_entries(starts.back(), matrix);
  for (std::size_t r = 0; r < starts.size(); ++r) matrix.outerIndexPtr()[r] = static_cast<int>(starts[r]);
}

/// The matrix whose rows these are.
template <typename Scratch, typename Make, typename Fill>
EnergyMatrix matrix_of_rows(Index rows, Index columns, const Make& make, const Fill& fill, const Progress& progress) {
  EnergyMatrix matrix(rows, columns);
  Buffer<std::size_t> starts;
  collect_rows<Scratch>(
      rows, make, fill, true, starts,
      [&](std::size_t count, std::size_t guess) {
        if (static_cast<std::size_t>(matrix.data().allocatedSize()) < count) {
          resize_entries(std::max(count, guess), matrix);
        }
        return RowsPlace{matrix.innerIndexPtr(), matrix.valuePtr()};
      },
      progress);
  set_starts(starts, matrix);
  return matrix;
}

}  // namespace batten
