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
};

/// A free row's entry in a column that is not free.
struct HeldEntry {
  Index row;
  Index column;
  double weight;
};

/// Memory: 8 bytes a row and 4 an entry off the diagonal.
class RowTable {
 public:
  static constexpr Index kBlock = 4096;

  explicit RowTable(const RowSource& source, const Progress& progress = {});

  Index size() const { return static_cast<Index>(places_.size()); }
  bool is_free(Index row) const { return pattern_of(row) >= 0; }
  Index free_count() const { return free_count_; }
  /// Pattern of a free row, or -1.
  Index pattern_of(Index row) const { return places_[row].pattern; }
  const Index* columns(Index row) const { return block_columns_[row / kBlock].data() + places_[row].begin; }
  Index column_count(Index row) const { return counts_[pattern_of(row)]; }
  /// Brings into the cache, ahead of its use, where the row's entries stand.
  void prefetch_place(Index row) const { __builtin_prefetch(&places_[row]); }
  /// Likewise the entries themselves, some rows later.
  void prefetch_columns(Index row) const {
    const Index* first = columns(row);
    __builtin_prefetch(first);
    __builtin_prefetch(first + 7);
  }
  const std::vector<RowPattern>& patterns() const { return patterns_; }
  /// In ascending order of rows.
  const std::vector<HeldEntry>& held() const { return held_; }

 private:
  struct Place {
    Index begin;  ///< of the row's entries among those of its block
    Index pattern;
  };
  /// What a block of rows has besides its columns, until all blocks are merged.
  struct Found {
    std::vector<RowPattern> patterns;
    std::vector<HeldEntry> held;
    Index free_count = 0;
  };
  void fill(const RowSource& source, Index first, Index last, Found& found);
  void merge(std::vector<Found>& found);

  Index free_count_ = 0;
  Buffer<Place> places_;
  std::vector<Buffer<Index>> block_columns_;
  Buffer<Index> counts_;  ///< entries off the diagonal, per pattern
  std::vector<RowPattern> patterns_;
  std::vector<HeldEntry> held_;
};

}  // namespace batten
