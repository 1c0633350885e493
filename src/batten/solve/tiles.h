/// \file The tiles of TiledIteration and the loops inside one.
#pragma once
#include <array>
#include <vector>

#include "batten/solve/row_table.h"

namespace batten {

/// Four columns side by side, as the compiler's vector types.
using Float4 = float __attribute__((vector_size(16)));
using Double4 = double __attribute__((vector_size(32)));

/// Rows [first_row, first_row + row_count) of a tile share a pattern; their columns follow each other in Tile::columns, but
/// for the last ring, whose rows are not needed.
struct TileSegment {
  Index first_row;
  Index row_count;
  Index pattern;
  Index first_column;
};

/// Unknowns in the order of their ring (0: the tile's own), and by pattern within a ring.
struct Tile {
  static constexpr int kRings = TiledIteration::kStepsPerRound;  ///< rings 0 .. kRings - 1

  std::array<Index, kRings> ring_end{};         ///< unknowns up to this ring
  std::array<Index, kRings> segment_end{};      ///< segments up to this ring
  Buffer<Index> globals;
  std::vector<TileSegment> segments;
  Buffer<std::uint16_t> columns;
  Index held_begin = 0;  ///< in Tiling::held
  Index held_end = 0;

  Index own_count() const { return ring_end[0]; }
};

struct TileHeldEntry {
  Index local_row;
  Index column;
  double weight;
};

struct Tiling {
  std::vector<Tile> tiles;
  std::vector<TileHeldEntry> held;
  std::vector<RowPattern> patterns;
  Index free_count = 0;
  double overlap = 0.0;
  double upper_bound = 0.0;
};

/// Throws nothing; a tiling that would need tiles of over 65,536 unknowns comes back with overlap infinite and no tiles.
Tiling make_tiling(const RowTable& rows);

/// One step on the rows of rings 0 .. last_ring:
/// previous <- now + momentum (now - previous) + step (residual - (now + sum normalised now)).
/// step_by_diagonal: step is multiplied with the row's diagonal (Richardson).
void tile_step(const Tile& tile, const std::vector<RowPattern>& patterns, int last_ring, float step, float momentum,
               bool step_by_diagonal, const Float4* residual, const Float4* now, Float4* previous);

/// product_i = sum of the row's weights times x, for the tile's own rows; x covers rings 0 and 1.
void tile_product(const Tile& tile, const std::vector<RowPattern>& patterns, const Double4* x, Double4* product);

}  // namespace batten
