/// \file The tiles of TiledIteration and the loops inside one.
#pragma once
#include <array>
#include <vector>

#include "batten/double4.h"
#include "batten/solve/remainder_rows.h"
#include "batten/solve/row_table.h"

namespace batten {

/// Four columns side by side, as Double4.
using Float4 = float __attribute__((vector_size(16)));

/// Rows [first_row, first_row + row_count) of a tile share a pattern; their columns follow each other in Tile::columns,
/// but for the last ring, whose rows are not needed.
struct TileSegment {
  Index first_row;
  Index row_count;
  Index pattern;
  Index first_column;
};

/// A patch of unknowns with the rings around it. Local unknown i is, for i < own_count, the unknown first + i in the
/// order of Tiling, and ghosts[i - own_count] after that; sorted by ring, and by pattern within a ring.
struct Tile {
  static constexpr int kRings = TiledIteration::kStepsPerRound;  ///< rings 0 (the tile's own) .. kRings - 1

  Index first = 0;
  Index own_count = 0;
  std::array<Index, kRings> ring_end{};     ///< local unknowns up to this ring
  std::array<Index, kRings> segment_end{};  ///< segments up to this ring
  Buffer<Index> ghosts;
  std::vector<TileSegment> segments;
  Buffer<std::uint16_t> columns;
  Buffer<double> weights;  ///< of E - A where each row has its own, see set_own_weights; else empty
};

/// What a thread keeps for its work on tiles, big enough for this one.
template <typename Scratch>
Scratch& scratch_for(const Tile& tile) {
  thread_local Scratch scratch;
  const auto size = static_cast<std::size_t>(tile.ring_end.back());
  if (scratch.size() < size) scratch.resize(size);
  return scratch;
}

/// All free unknowns, numbered tile after tile.
struct Tiling {
  std::vector<Tile> tiles;
  Buffer<Index> order;          ///< the row of each unknown
  std::vector<HeldEntry> held;  ///< with `row` an unknown's place in `order`
  std::vector<RowPattern> patterns;
  double overlap = 0.0;
};

/// Throws Error(Cancelled) only; a tiling that would need tiles of over 65,536 unknowns comes back with overlap
/// infinite and no tiles.
Tiling make_tiling(const RowTable& rows, const Progress& progress = {});

/// Gives the tiles of G = E - A the weights of its rows: for each row with columns those off the diagonal as they come,
/// then that on the diagonal. `tiling` is that of rows which have the columns of G in the same order.
void set_own_weights(const RemainderRows& rows, Tiling& tiling, const Progress& progress = {});

/// One step on the rows of rings 0 .. last_ring:
/// previous <- now + momentum (now - previous) + step (residual - (now + sum normalised now)).
/// step_by_diagonal: step is multiplied with the row's diagonal (Richardson).
void tile_step(const Tile& tile, const std::vector<RowPattern>& patterns, int last_ring, float step, float momentum,
               bool step_by_diagonal, const Float4* residual, const Float4* now, Float4* previous);

/// product_i = sum of the row's weights times x, for the tile's own rows; x covers rings 0 and 1.
void tile_product(const Tile& tile, const std::vector<RowPattern>& patterns, const Double4* x, Double4* product);

/// remainder_i = x_i less the sum of the row's weights times x, or the sum of the row's own weights of E - A times x,
/// on the rows of rings 0 .. last_ring; x covers one ring more.
void tile_remainder(const Tile& tile, const std::vector<RowPattern>& patterns, int last_ring, const Double4* x,
                    Double4* remainder);

}  // namespace batten
