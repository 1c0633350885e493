/// \file Compact patches of unknowns, grown one after the other.
#pragma once
#include "batten/solve/row_table.h"

namespace batten {

/// Grows the tiles breadth-first one after the other, each from where the ones before stopped. It depends on the rows'
/// columns only, never on threads; other threads may work on the tiles that are grown meanwhile.
/// Memory: about 2 bytes a row.
class TileGrowth {
 public:
  /// Room for the free rows in the order of tiles, tile t being [begin_of(t), begin_of(t + 1)).
  TileGrowth(const RowTable& rows, Index tile_count);

  Index begin_of(Index tile) const { return static_cast<Index>(std::int64_t{rows_.free_count()} * tile / tile_count_); }

  /// Takes the rows of the next tile into `order`, which has one place a free row.
  void grow_next(Buffer<Index>& order);

 private:
  Index next_seed();
  Index take_neighbours(Index row, Index taken_count, Index target, Buffer<Index>& order);
  void remember_rim(Index first, Index last, const Buffer<Index>& order);

  const RowTable& rows_;
  Index tile_count_;
  Index tile_ = 0;
  Buffer<std::uint8_t> taken_;
  Buffer<Index> seeds_;  ///< met but not taken when a tile was full
  std::size_t seed_ = 0;
  Index scan_ = 0;
};

}  // namespace batten
