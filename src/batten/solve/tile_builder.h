/// \file What surrounds a tile, found ring after ring.
#pragma once
#include <vector>

#include "batten/solve/tiles.h"

namespace batten {

/// The places of some thousand rows in a tile: a hash table with linear probing, so that its memory follows the tile
/// and not the system.
class LocalPlaces {
 public:
  /// Forgets all rows; room for `expected` before it must grow.
  void clear(Index expected);

  /// The place of a row; gives it the next one, counted from 0, if it has none.
  Index find_or_add(Index row) {
    std::size_t slot = slot_of(row);
    while (table_[slot].row != row) {
      if (table_[slot].row < 0) return add(slot, row);
      slot = (slot + 1) & mask_;
    }
    return table_[slot].place;
  }

  /// The rows in the order of their places.
  const Buffer<Index>& rows() const { return rows_; }
  Index count() const { return static_cast<Index>(rows_.size()); }

 private:
  struct Slot {
    Index row;
    Index place;
  };
  std::size_t slot_of(Index row) const {
    return static_cast<std::size_t>((static_cast<std::uint32_t>(row) * 0x9E3779B9U) >> shift_);
  }
  Index add(std::size_t slot, Index row);
  void reset_table(int bits);

  Buffer<Slot> table_;
  std::size_t mask_ = 0;
  int shift_ = 0;
  Buffer<Index> rows_;
};

/// Builds tile after tile. A thread keeps one of these for its work: some 200 KB, whatever the system's size.
class TileBuilder {
 public:
  /// own: the tile's rows, which it sorts by pattern. Its ghosts come as rows, not as unknowns. False when the tile
  /// would have more than 65,536 unknowns.
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
