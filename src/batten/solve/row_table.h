/// \file The rows of a sparse system with their weights stored once a pattern, as TiledIteration builds from them.
#pragma once
#include <vector>

#include "batten/solve/tiled_iteration.h"

namespace batten {

/// Rows that have the same weights in the same order share a pattern: on a regular mesh nearly all rows do.
struct RowPattern {
  double diagonal = 0.0;
  std::vector<double> weights;    ///< off the diagonal, as they come
  std::vector<float> normalised;  ///< weights / diagonal
  double off_diagonal_sum = 0.0;  ///< of |weights| / diagonal
};

/// A free row's entry in a column that is not free.
struct HeldEntry {
  Index row;
  Index column;
  double weight;
};

class RowTable {
 public:
  static constexpr Index kBlock = 4096;

  explicit RowTable(const RowSource& source, const Progress& progress = {});

  Index size() const { return size_; }
  bool is_free(Index row) const { return pattern_of(row) >= 0; }
  Index free_count() const { return free_count_; }
  /// Pattern of a free row, or -1.
  Index pattern_of(Index row) const { return blocks_[row / kBlock].patterns[row % kBlock]; }
  const Index* columns(Index row) const {
    const Block& block = blocks_[row / kBlock];
    return block.columns.data() + block.begins[row % kBlock];
  }
  /// Brings a row's entries into the cache ahead of their use.
  void prefetch(Index row) const {
    const Block& block = blocks_[row / kBlock];
    __builtin_prefetch(&block.patterns[row % kBlock]);
    __builtin_prefetch(block.columns.data() + block.begins[row % kBlock]);
  }
  Index column_count(Index row) const { return static_cast<Index>(patterns_[pattern_of(row)].weights.size()); }
  const std::vector<RowPattern>& patterns() const { return patterns_; }
  /// In ascending order of rows.
  const std::vector<HeldEntry>& held() const { return held_; }

 private:
  struct Block {
    Buffer<Index> patterns;
    Buffer<Index> begins;
    Buffer<Index> columns;
    std::vector<RowPattern> found;
    std::vector<HeldEntry> held;
  };
  static void fill(const RowSource& source, Index first, Index last, Block& block);
  void merge_patterns();

  Index size_;
  Index free_count_ = 0;
  std::vector<Block> blocks_;
  std::vector<RowPattern> patterns_;
  std::vector<HeldEntry> held_;
};

}  // namespace batten
