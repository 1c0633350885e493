#include "batten/solve/tiles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "batten/parallel/parallel.h"

namespace batten {

namespace {

constexpr Index kTileSize = 4096;
constexpr Index kMostLocals = 65536;

/// An even number of tiles of nearly equal size, so that two threads share them well; independent of the threads.
Index tile_count_for(Index free_count) {
  if (free_count <= kTileSize / 2) return free_count > 0 ? 1 : 0;
  return 2 * ((free_count + 2 * kTileSize - 1) / (2 * kTileSize));
}

/// Grows the tiles breadth-first one after the other, each from where the ones before stopped: compact patches. Returns the
/// free rows in the order of tiles, tile t being [t n/count, (t+1) n/count).
Buffer<Index> grow_tiles(const RowTable& rows, Index count) {
  Buffer<Index> order;
  order.reserve(static_cast<std::size_t>(rows.free_count()));
  std::vector<std::uint8_t> taken(static_cast<std::size_t>(rows.size()), 0);
  Buffer<Index> seeds;  // met but not taken when a tile was full
  std::size_t next_seed = 0;
  Index scan = 0;
  for (Index t = 0; t < count; ++t) {
    const auto target = static_cast<std::size_t>(std::int64_t{rows.free_count()} * (t + 1) / count);
    std::size_t head = order.size();
    while (order.size() < target) {
      if (head == order.size()) {
        while (next_seed < seeds.size() && taken[seeds[next_seed]] != 0) ++next_seed;
        Index seed = 0;
        if (next_seed < seeds.size()) {
          seed = seeds[next_seed];
        } else {
          while (taken[scan] != 0 || !rows.is_free(scan)) ++scan;
          seed = scan;
        }
        taken[seed] = 1;
        order.push_back(seed);
        continue;
      }
      const Index row = order[head++];
      const Index* columns = rows.columns(row);
      for (Index i = 0; i < rows.column_count(row) && order.size() < target; ++i) {
        if (taken[columns[i]] != 0) continue;
        taken[columns[i]] = 1;
        order.push_back(columns[i]);
      }
    }
    for (; head < order.size(); ++head) {
      const Index* columns = rows.columns(order[head]);
      for (Index i = 0; i < rows.column_count(order[head]); ++i) {
        if (taken[columns[i]] == 0) seeds.push_back(columns[i]);
      }
    }
  }
  return order;
}

/// Adds the rings around the tile's own unknowns. local holds -1 everywhere before and after. False when too large.
bool add_rings(const RowTable& rows, Buffer<Index>& local, Tile& tile) {
  for (std::size_t i = 0; i < tile.globals.size(); ++i) local[tile.globals[i]] = static_cast<Index>(i);
  tile.ring_end[0] = static_cast<Index>(tile.globals.size());
  Index begin = 0;
  for (int ring = 1; ring < Tile::kRings; ++ring) {
    const Index end = tile.ring_end[ring - 1];
    for (Index i = begin; i < end; ++i) {
      const Index row = tile.globals[i];
      const Index* columns = rows.columns(row);
      for (Index k = 0; k < rows.column_count(row); ++k) {
        if (local[columns[k]] >= 0) continue;
        local[columns[k]] = static_cast<Index>(tile.globals.size());
        tile.globals.push_back(columns[k]);
      }
    }
    begin = end;
    tile.ring_end[ring] = static_cast<Index>(tile.globals.size());
    if (tile.globals.size() > static_cast<std::size_t>(kMostLocals)) return false;
  }
  return true;
}

void sort_rings_by_pattern(const RowTable& rows, Buffer<Index>& local, Tile& tile) {
  Index begin = 0;
  for (const Index end : tile.ring_end) {
    std::stable_sort(tile.globals.begin() + begin, tile.globals.begin() + end,
                     [&](Index a, Index b) { return rows.pattern_of(a) < rows.pattern_of(b); });
    begin = end;
  }
  for (std::size_t i = 0; i < tile.globals.size(); ++i) local[tile.globals[i]] = static_cast<Index>(i);
}

void write_rows(const RowTable& rows, const Buffer<Index>& local, Tile& tile) {
  Index row = 0;
  std::size_t entry_count = 0;
  for (Index i = 0; i < tile.ring_end[Tile::kRings - 2]; ++i) entry_count += rows.column_count(tile.globals[i]);
  tile.columns.reserve(entry_count);
  for (int ring = 0; ring < Tile::kRings; ++ring) {
    const bool has_rows = ring + 1 < Tile::kRings;
    bool fresh = true;
    for (; row < tile.ring_end[ring]; ++row) {
      const Index global = tile.globals[row];
      const Index pattern = rows.pattern_of(global);
      if (fresh || tile.segments.back().pattern != pattern) {
        tile.segments.push_back({row, 0, pattern, static_cast<Index>(tile.columns.size())});
        fresh = false;
      }
      ++tile.segments.back().row_count;
      if (!has_rows) continue;
      const Index* columns = rows.columns(global);
      for (Index k = 0; k < rows.column_count(global); ++k) {
        tile.columns.push_back(static_cast<std::uint16_t>(local[columns[k]]));
      }
    }
    tile.segment_end[ring] = static_cast<Index>(tile.segments.size());
  }
}

bool build_tile(const RowTable& rows, Buffer<Index>& local, Tile& tile) {
  const bool fits = add_rings(rows, local, tile);
  if (fits) {
    sort_rings_by_pattern(rows, local, tile);
    write_rows(rows, local, tile);
    tile.globals.shrink_to_fit();
  }
  for (const Index global : tile.globals) local[global] = -1;
  return fits;
}

void place_held_entries(const RowTable& rows, Tiling& tiling) {
  if (rows.held().empty()) return;
  std::vector<Index> first(static_cast<std::size_t>(rows.size()) + 1, 0);
  for (const HeldEntry& entry : rows.held()) ++first[entry.row + 1];
  for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
  for (Tile& tile : tiling.tiles) {
    tile.held_begin = static_cast<Index>(tiling.held.size());
    for (Index i = 0; i < tile.own_count(); ++i) {
      const Index row = tile.globals[i];
      for (Index k = first[row]; k < first[row + 1]; ++k) {
        tiling.held.push_back({i, rows.held()[k].column, rows.held()[k].weight});
      }
    }
    tile.held_end = static_cast<Index>(tiling.held.size());
  }
}

double brauer_bound(const RowTable& rows) {
  const std::vector<RowPattern>& patterns = rows.patterns();
  const double most = parallel_reduce(
      rows.size(), 0.0,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        double product = 0.0;
        for (auto row = static_cast<Index>(begin); row < end; ++row) {
          if (!rows.is_free(row)) continue;
          const double sum = patterns[rows.pattern_of(row)].off_diagonal_sum;
          const Index* columns = rows.columns(row);
          for (Index k = 0; k < rows.column_count(row); ++k) {
            product = std::max(product, sum * patterns[rows.pattern_of(columns[k])].off_diagonal_sum);
          }
        }
        return product;
      },
      [](double a, double b) { return std::max(a, b); });
  return 1.0 + std::sqrt(most);
}

/// The rows of a segment; M is the number of columns of a row, 0 when it is known only at run time.
template <int M>
void step_segment(const TileSegment& segment, Index count, const float* weights, const std::uint16_t* columns, float step,
                  float momentum, const Float4* residual, const Float4* now, Float4* previous) {
  float local[M > 0 ? M : 1];
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

using StepSegment = void (*)(const TileSegment&, Index, const float*, const std::uint16_t*, float, float, const Float4*,
                             const Float4*, Float4*);

StepSegment step_for(Index count) {
  static constexpr StepSegment kTable[] = {
      step_segment<0>, step_segment<1>, step_segment<2>, step_segment<3>,  step_segment<4>,  step_segment<5>, step_segment<6>,
      step_segment<7>, step_segment<8>, step_segment<9>, step_segment<10>, step_segment<11>, step_segment<12>};
  return count < static_cast<Index>(std::size(kTable)) ? kTable[count] : kTable[0];
}

}  // namespace

Tiling make_tiling(const RowTable& rows) {
  Tiling tiling;
  tiling.free_count = rows.free_count();
  tiling.patterns = rows.patterns();
  tiling.upper_bound = brauer_bound(rows);
  const Index count = tile_count_for(rows.free_count());
  const Buffer<Index> order = grow_tiles(rows, count);
  tiling.tiles.resize(static_cast<std::size_t>(count));
  const std::ptrdiff_t groups = std::min<std::ptrdiff_t>(count, thread_count());
  std::vector<std::uint8_t> fits(static_cast<std::size_t>(count), 0);
  parallel_for_each(groups, [&](std::ptrdiff_t group) {
    Buffer<Index> local(static_cast<std::size_t>(rows.size()), -1);
    for (std::ptrdiff_t t = count * group / groups; t < count * (group + 1) / groups; ++t) {
      const std::int64_t n = rows.free_count();
      tiling.tiles[t].globals.assign(order.begin() + n * t / count, order.begin() + n * (t + 1) / count);
      fits[t] = build_tile(rows, local, tiling.tiles[t]) ? 1 : 0;
    }
  });
  if (std::count(fits.begin(), fits.end(), 0) > 0) {
    tiling.tiles.clear();
    tiling.overlap = std::numeric_limits<double>::infinity();
    return tiling;
  }
  place_held_entries(rows, tiling);
  double held = 0.0;
  for (const Tile& tile : tiling.tiles) held += static_cast<double>(tile.globals.size());
  tiling.overlap = tiling.free_count > 0 ? held / tiling.free_count : 1.0;
  return tiling;
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

}  // namespace batten
