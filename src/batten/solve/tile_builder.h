/// \file What surrounds a tile, found ring after ring.
#pragma once
#include <vector>

#include "batten/solve/tiles.h"

namespace batten {

/// The places of some thousand rows in a tile. Rows that follow each other share a page of places, and a directory has
/// the page of each row, so that a row is found without a search. Memory: a page for each run of rows that is met, and
/// 1/16 byte for each row of the system.
class LocalPlaces {
 public:
  /// How many rows can have places.
  static constexpr Index kMost = 65535;

  /// Forgets all rows. Rows are then numbers below `row_count`.
  void clear(Index row_count);

  /// The place of a row; gives it the next one, counted from 0, if it has none. kMost when there are no more.
  Index find_or_add(Index row) {
    const std::uint16_t place = pages_[slot_of(row)];
    return place != kMost ? place : add(row);
  }

  /// The rows in the order of their places.
  const Buffer<Index>& rows() const { return rows_; }
  Index count() const { return static_cast<Index>(rows_.size()); }

 private:
  static constexpr int kPageBits = 5;
  static constexpr Index kPageRows = Index{1} << kPageBits;

  std::size_t slot_of(Index row) const {
    return static_cast<std::size_t>(directory_[row >> kPageBits]) * kPageRows +
           static_cast<std::size_t>(row & (kPageRows - 1));
  }
  Index add(Index row);

  Buffer<std::uint16_t> directory_;  ///< the page of each run of rows; page 0, where no row was met
  Buffer<std::uint16_t> pages_;      ///< places, kMost for a row that has none; page 0 stays empty
  Buffer<Index> rows_;
};

/// Builds tile after tile. A thread keeps one of these for its work: some 500 KB and 1/16 byte for each row of the
/// system.
class TileBuilder {
 public:
  /// own: the tile's rows, which it sorts by pattern. Its ghosts come as rows, not as unknowns. False when the tile
  /// would have more than 65,535 unknowns.
  bool build(const RowTable& rows, Index* own, Tile& tile);

 private:
  bool add_rings(const RowTable& rows, Tile& tile);
  void sort_rings(const RowTable& rows, const Tile& tile);
  void write_rows(const RowTable& rows, Tile& tile);
  void sort_by_pattern(const RowTable& rows, Index* first, Index count, const Index* row_of);

  LocalPlaces places_;
  Buffer<Index> entries_;  ///< the columns of all rows but the last ring's, as places
  Buffer<Index> sorted_;
  Buffer<Index> starts_;
  Buffer<std::uint16_t> new_place_;
  Buffer<Index> patterns_;
  Buffer<Index> spare_;
};

}  // namespace batten
