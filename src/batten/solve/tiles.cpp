#include "batten/solve/tiles.h"

#include <algorithm>
#include <limits>

#include "batten/parallel/parallel.h"
#include "batten/solve/tile_builder.h"
#include "batten/solve/tile_growth.h"

namespace batten {

namespace {

constexpr Index kTileSize = 4096;

/// Tiles that are grown while those before them are built.
constexpr Index kTilesAhead = 16;

/// An even number of tiles of nearly equal size, so that two threads share them well; independent of the threads.
Index tile_count_for(Index free_count) {
  if (free_count <= kTileSize / 2) return free_count > 0 ? 1 : 0;
  return 2 * ((free_count + 2 * kTileSize - 1) / (2 * kTileSize));
}

/// The rows of a segment; M is the number of columns of a row, 0 when it is known only at run time.
template <int M>
void step_segment(const TileSegment& segment, Index count, const float* weights, const std::uint16_t* columns,
                  float step, float momentum, const Float4* residual, const Float4* now, Float4* previous) {
  float local[std::max(M, 1)];
  for (int k = 0; k < M; ++k) local[k] = weights[k];
  const Index last = segment.first_row + segment.row_count;
  for (Index i = segment.first_row; i < last; ++i) {
    Float4 product = now[i];
    if constexpr (M > 0) {
      for (int k = 0; k < M; ++k) product += local[k] * now[columns[k]];
      columns += M;
    } else {
      for (Index k = 0; k < count; ++k) product += weights[k] * now[columns[k]];
      columns += count;
    }
    previous[i] = now[i] + momentum * (now[i] - previous[i]) + step * (residual[i] - product);
  }
}

template <int M>
void remainder_segment(const TileSegment& segment, const RowPattern& pattern, const std::uint16_t* columns,
                       const Double4* x, Double4* remainder) {
  const auto count = static_cast<Index>(pattern.weights.size());
  double local[std::max(M, 1)];
  for (int k = 0; k < M; ++k) local[k] = pattern.weights[k];
  const Index last = segment.first_row + segment.row_count;
  for (Index i = segment.first_row; i < last; ++i) {
    Double4 product = pattern.diagonal * x[i];
    if constexpr (M > 0) {
      for (int k = 0; k < M; ++k) product += local[k] * x[columns[k]];
      columns += M;
    } else {
      for (Index k = 0; k < count; ++k) product += pattern.weights[k] * x[columns[k]];
      columns += count;
    }
    remainder[i] = x[i] - product;
  }
}

using RemainderSegment = void (*)(const TileSegment&, const RowPattern&, const std::uint16_t*, const Double4*,
                                  Double4*);

RemainderSegment remainder_for(std::size_t count) {
  static constexpr RemainderSegment kTable[] = {remainder_segment<0>, remainder_segment<1>, remainder_segment<2>,
                                                remainder_segment<3>, remainder_segment<4>, remainder_segment<5>,
                                                remainder_segment<6>, remainder_segment<7>, remainder_segment<8>};
  return count < std::size(kTable) ? kTable[count] : kTable[0];
}

/// weights: of the segment's rows, those off the diagonal and then that on it.
template <int M>
void own_remainder_segment(const TileSegment& segment, Index run_time_count, const double* weights,
                           const std::uint16_t* columns, const Double4* x, Double4* remainder) {
  const Index count = M > 0 ? M : run_time_count;
  const Index last = segment.first_row + segment.row_count;
  for (Index i = segment.first_row; i < last; ++i) {
    Double4 sum{0.0, 0.0, 0.0, 0.0};
    for (Index k = 0; k < count; ++k) sum += weights[k] * x[columns[k]];
    remainder[i] = sum + weights[count] * x[i];
    columns += count;
    weights += count + 1;
  }
}

using OwnRemainderSegment = void (*)(const TileSegment&, Index, const double*, const std::uint16_t*, const Double4*,
                                     Double4*);

OwnRemainderSegment own_remainder_for(Index count) {
  static constexpr OwnRemainderSegment kTable[] = {
      own_remainder_segment<0>, own_remainder_segment<1>, own_remainder_segment<2>,
      own_remainder_segment<3>, own_remainder_segment<4>, own_remainder_segment<5>,
      own_remainder_segment<6>, own_remainder_segment<7>, own_remainder_segment<8>};
  return count < static_cast<Index>(std::size(kTable)) ? kTable[count] : kTable[0];
}

/// Where the weights of a segment's rows begin: each row before them has one on the diagonal beside its columns.
std::size_t first_weight(const TileSegment& segment) {
  return static_cast<std::size_t>(segment.first_column) + static_cast<std::size_t>(segment.first_row);
}

using StepSegment = void (*)(const TileSegment&, Index, const float*, const std::uint16_t*, float, float, const Float4*,
                             const Float4*, Float4*);

StepSegment step_for(Index count) {
  static constexpr StepSegment kTable[] = {step_segment<0>, step_segment<1>, step_segment<2>,  step_segment<3>,
                                           step_segment<4>, step_segment<5>, step_segment<6>,  step_segment<7>,
                                           step_segment<8>, step_segment<9>, step_segment<10>, step_segment<11>,
                                           step_segment<12>};
  return count < static_cast<Index>(std::size(kTable)) ? kTable[count] : kTable[0];
}

}  // namespace

Tiling make_tiling(const RowTable& rows, const Progress& progress) {
  Tiling tiling;
  tiling.patterns = rows.patterns();
  const Index count = tile_count_for(rows.free_count());
  TileGrowth growth(rows, count);
  tiling.order.resize(static_cast<std::size_t>(rows.free_count()));
  tiling.tiles.resize(static_cast<std::size_t>(count));
  Buffer<Index> unknown_of(static_cast<std::size_t>(rows.size()));
  std::vector<std::uint8_t> fits(static_cast<std::size_t>(count), 0);
  const auto build = [&](Index t) {
    thread_local TileBuilder builder;
    Tile& tile = tiling.tiles[t];
    tile.first = growth.begin_of(t);
    tile.own_count = growth.begin_of(t + 1) - tile.first;
    fits[t] = builder.build(rows, tiling.order.data() + tile.first, tile) ? 1 : 0;
    for (Index i = tile.first; i < tile.first + tile.own_count; ++i) unknown_of[tiling.order[i]] = i;
  };
  // Growing is serial, but what surrounds a tile can be found as soon as the tile itself is grown.
  Index grown = 0;
  for (Index built = 0; built < count;) {
    report_progress(progress, static_cast<double>(built) / count);
    const Index next = std::min(grown + kTilesAhead, count);
    parallel_for_each(grown - built + 1, [&](std::ptrdiff_t i) {
      if (i > 0) return build(built + static_cast<Index>(i) - 1);
      for (Index t = grown; t < next; ++t) growth.grow_next(tiling.order);
    });
    built = grown;
    grown = next;
  }
  if (std::count(fits.begin(), fits.end(), 0) != 0) {
    tiling.tiles.clear();
    tiling.overlap = std::numeric_limits<double>::infinity();
    return tiling;
  }
  parallel_for_each(count, [&](std::ptrdiff_t t) {
    for (Index& ghost : tiling.tiles[t].ghosts) ghost = unknown_of[ghost];
  });
  tiling.held = rows.held();
  for (HeldEntry& entry : tiling.held) entry.row = unknown_of[entry.row];
  double locals = 0.0;
  for (const Tile& tile : tiling.tiles) locals += tile.ring_end.back();
  tiling.overlap = count > 0 ? locals / rows.free_count() : 1.0;
  return tiling;
}

void set_own_weights(const RemainderRows& rows, Tiling& tiling, const Progress& progress) {
  const auto set = [&](std::ptrdiff_t t) {
    Tile& tile = tiling.tiles[t];
    const Index with_rows = tile.ring_end[Tile::kRings - 2];
    tile.weights.resize(tile.columns.size() + static_cast<std::size_t>(with_rows));
    double* next = tile.weights.data();
    for (Index i = 0; i < with_rows; ++i) {
      const Index row = tiling.order[i < tile.own_count ? tile.first + i : tile.ghosts[i - tile.own_count]];
      const auto begin = rows.weights.begin() + static_cast<std::ptrdiff_t>(rows.offsets[row]);
      const auto end = rows.weights.begin() + static_cast<std::ptrdiff_t>(rows.offsets[row + 1]);
      if (begin == end) *next++ = 0.0;
      next = std::copy(begin, end, next);
    }
  };
  parallel_for_each(static_cast<std::ptrdiff_t>(tiling.tiles.size()), set, progress);
}

void tile_step(const Tile& tile, const std::vector<RowPattern>& patterns, int last_ring, float step, float momentum,
               bool step_by_diagonal, const Float4* residual, const Float4* now, Float4* previous) {
  for (Index s = 0; s < tile.segment_end[last_ring]; ++s) {
    const TileSegment& segment = tile.segments[s];
    const RowPattern& pattern = patterns[segment.pattern];
    const auto count = static_cast<Index>(pattern.weights.size());
    const float row_step = step_by_diagonal ? step * static_cast<float>(pattern.diagonal) : step;
    step_for(count)(segment, count, pattern.normalised.data(), tile.columns.data() + segment.first_column, row_step,
                    momentum, residual, now, previous);
  }
}

void tile_product(const Tile& tile, const std::vector<RowPattern>& patterns, const Double4* x, Double4* product) {
  for (Index s = 0; s < tile.segment_end[0]; ++s) {
    const TileSegment& segment = tile.segments[s];
    const RowPattern& pattern = patterns[segment.pattern];
    const auto count = static_cast<Index>(pattern.weights.size());
    const std::uint16_t* columns = tile.columns.data() + segment.first_column;
    for (Index i = segment.first_row; i < segment.first_row + segment.row_count; ++i, columns += count) {
      Double4 sum = pattern.diagonal * x[i];
      for (Index k = 0; k < count; ++k) sum += pattern.weights[k] * x[columns[k]];
      product[i] = sum;
    }
  }
}

void tile_remainder(const Tile& tile, const std::vector<RowPattern>& patterns, int last_ring, const Double4* x,
                    Double4* remainder) {
  const bool has_own = !tile.weights.empty();
  for (Index s = 0; s < tile.segment_end[last_ring]; ++s) {
    const TileSegment& segment = tile.segments[s];
    const RowPattern& pattern = patterns[segment.pattern];
    if (has_own) {
      const auto count = static_cast<Index>(pattern.weights.size());
      own_remainder_for(count)(segment, count, tile.weights.data() + first_weight(segment),
                               tile.columns.data() + segment.first_column, x, remainder);
      continue;
    }
    remainder_for(pattern.weights.size())(segment, pattern, tile.columns.data() + segment.first_column, x, remainder);
  }
}

}  // namespace batten
