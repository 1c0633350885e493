#include "batten/solve/tiles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "batten/parallel/parallel.h"

namespace batten {

namespace {

constexpr Index kTileSize = 4096;
constexpr Index kMostLocals = 65536;
constexpr Index kAhead = 12;  // rows to prefetch ahead: memory answers in the time of about so many

/// An even number of tiles of nearly equal size, so that two threads share them well; independent of the threads.
Index tile_count_for(Index free_count) {
  if (free_count <= kTileSize / 2) return free_count > 0 ? 1 : 0;
  return 2 * ((free_count + 2 * kTileSize - 1) / (2 * kTileSize));
}

/// Grows the tiles breadth-first one after the other, each from where the ones before stopped: compact patches. Returns
/// the free rows in the order of tiles, tile t being [t n/count, (t+1) n/count).
Buffer<Index> grow_tiles(const RowTable& rows, Index count, const Progress& progress) {
  Buffer<Index> order;
  order.reserve(static_cast<std::size_t>(rows.free_count()));
  std::vector<std::uint8_t> taken(static_cast<std::size_t>(rows.size()), 0);
  Buffer<Index> seeds;  // met but not taken when a tile was full
  std::size_t next_seed = 0;
  Index scan = 0;
  for (Index t = 0; t < count; ++t) {
    report_progress(progress, static_cast<double>(t) / count);
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
      if (head + kAhead < order.size()) rows.prefetch(order[head + kAhead]);
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

/// Builds the rings around one tile after the other; a thread keeps one of these.
class TileBuilder {
 public:
  TileBuilder(const RowTable& rows, const Buffer<Index>& order, const Buffer<Index>& place)
      : rows_(rows), order_(order), place_(place), local_(order.size(), -1) {}

  /// The tile has its own unknowns already. False when it grows too large.
  bool build(Tile& tile) {
    const bool fits = add_rings(tile);
    if (fits) write_rows(tile);
    for (const Index ghost : tile.ghosts) local_[ghost] = -1;
    if (fits) sort_ghosts(tile);
    return fits;
  }

 private:
  Index unknown(const Tile& tile, Index local) const {
    return local < tile.own_count ? tile.first + local : tile.ghosts[local - tile.own_count];
  }

  Index local_of(Tile& tile, Index unknown) {
    const Index own = unknown - tile.first;
    if (own >= 0 && own < tile.own_count) return own;
    if (local_[unknown] < 0) {
      local_[unknown] = tile.own_count + static_cast<Index>(tile.ghosts.size());
      tile.ghosts.push_back(unknown);
    }
    return local_[unknown];
  }

  /// Meets ring after ring; entries_ collects the columns of all rows but the last ring's, as local numbers.
  bool add_rings(Tile& tile) {
    tile.ring_end[0] = tile.own_count;
    std::size_t used = 0;
    Index begin = 0;
    for (int ring = 1; ring < Tile::kRings; ++ring) {
      const Index end = tile.ring_end[ring - 1];
      for (Index i = begin; i < end; ++i) {
        if (i + kAhead < end) rows_.prefetch(order_[unknown(tile, i + kAhead)]);
        const Index row = order_[unknown(tile, i)];
        const Index* columns = rows_.columns(row);
        const Index count = rows_.column_count(row);
        if (used + count > entries_.size()) entries_.resize(2 * (used + count));
        for (Index k = 0; k < count; ++k) entries_[used + k] = local_of(tile, place_[columns[k]]);
        used += count;
      }
      begin = end;
      tile.ring_end[ring] = tile.own_count + static_cast<Index>(tile.ghosts.size());
      if (tile.ring_end[ring] > kMostLocals) return false;
    }
    return true;
  }

  /// new_place_: the sorted place of each local unknown; own unknowns are sorted already.
  void sort_rings(const Tile& tile) {
    const Index all = tile.ring_end.back();
    sorted_.resize(static_cast<std::size_t>(all));
    std::iota(sorted_.begin(), sorted_.end(), 0);
    Index begin = tile.own_count;
    for (int ring = 1; ring < Tile::kRings; ++ring) {
      std::stable_sort(sorted_.begin() + begin, sorted_.begin() + tile.ring_end[ring],
                       [&](Index a, Index b) { return pattern(tile, a) < pattern(tile, b); });
      begin = tile.ring_end[ring];
    }
    new_place_.resize(sorted_.size());
    for (Index i = 0; i < all; ++i) new_place_[sorted_[i]] = static_cast<std::uint16_t>(i);
  }

  Index pattern(const Tile& tile, Index local) const { return rows_.pattern_of(order_[unknown(tile, local)]); }

  void write_rows(Tile& tile) {
    sort_rings(tile);
    starts_.resize(sorted_.size());
    Index start = 0;
    for (Index i = 0; i < tile.ring_end[Tile::kRings - 2]; ++i) {
      starts_[i] = start;
      start += rows_.column_count(order_[unknown(tile, i)]);
    }
    tile.columns.resize(static_cast<std::size_t>(start));
    std::uint16_t* column = tile.columns.data();
    Index row = 0;
    for (int ring = 0; ring < Tile::kRings; ++ring) {
      const bool has_rows = ring + 1 < Tile::kRings;
      bool fresh = true;
      for (; row < tile.ring_end[ring]; ++row) {
        const Index local = sorted_[row];
        const Index shape = pattern(tile, local);
        if (fresh || tile.segments.back().pattern != shape) {
          tile.segments.push_back({row, 0, shape, static_cast<Index>(column - tile.columns.data())});
          fresh = false;
        }
        ++tile.segments.back().row_count;
        if (!has_rows) continue;
        const auto count = static_cast<Index>(rows_.patterns()[shape].weights.size());
        const Index* entry = entries_.data() + starts_[local];
        for (Index k = 0; k < count; ++k) *column++ = new_place_[entry[k]];
      }
      tile.segment_end[ring] = static_cast<Index>(tile.segments.size());
    }
  }

  void sort_ghosts(Tile& tile) const {
    Buffer<Index> ghosts(tile.ghosts.size());
    for (std::size_t i = 0; i < ghosts.size(); ++i)
      ghosts[i] = tile.ghosts[sorted_[tile.own_count + i] - tile.own_count];
    tile.ghosts = std::move(ghosts);
  }

  const RowTable& rows_;
  const Buffer<Index>& order_;
  const Buffer<Index>& place_;
  Buffer<Index> local_;
  Buffer<Index> entries_;
  Buffer<Index> sorted_;
  Buffer<Index> starts_;
  Buffer<std::uint16_t> new_place_;
};

/// Each thread takes a run of neighbouring tiles, some between two reports. False when a tile grows too large.
bool build_tiles(const RowTable& rows, const Buffer<Index>& place, Tiling& tiling, const Progress& progress) {
  constexpr std::ptrdiff_t kBetweenReports = 32;
  const auto count = static_cast<std::ptrdiff_t>(tiling.tiles.size());
  if (count == 0) return true;
  const std::ptrdiff_t groups = std::min<std::ptrdiff_t>(count, thread_count());
  const std::ptrdiff_t group_size = block_count(count, groups);
  const std::ptrdiff_t step = progress ? kBetweenReports : group_size;
  std::vector<std::optional<TileBuilder>> builders(static_cast<std::size_t>(groups));
  std::vector<std::uint8_t> fits(static_cast<std::size_t>(count), 0);
  for (std::ptrdiff_t done = 0; done < group_size; done += step) {
    report_progress(progress, static_cast<double>(done) / static_cast<double>(group_size));
    parallel_for_each(groups, [&](std::ptrdiff_t group) {
      if (!builders[group]) builders[group].emplace(rows, tiling.order, place);
      const std::ptrdiff_t begin = group * group_size + done;
      const std::ptrdiff_t end = std::min({begin + step, (group + 1) * group_size, count});
      for (std::ptrdiff_t t = begin; t < end; ++t) fits[t] = builders[group]->build(tiling.tiles[t]) ? 1 : 0;
    });
  }
  return std::count(fits.begin(), fits.end(), 0) == 0;
}

/// The spectral radius of a matrix of weights |G| is at most max_i (|G| u)_i / u_i for any positive u; power iteration
/// on u brings the bound down to it (Collatz 1942, Wielandt 1950).
double collatz_bound(const RowTable& rows) {
  constexpr int kSteps = 4;
  const auto size = static_cast<std::size_t>(rows.size());
  Buffer<float> u(size, 1.0F);
  Buffer<float> next(size);
  double bound = 0.0;
  for (int step = 0; step < kSteps; ++step) {
    const double most = parallel_reduce(
        rows.size(), 0.0,
        [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          double ratio = 0.0;
          for (auto row = static_cast<Index>(begin); row < end; ++row) {
            if (!rows.is_free(row)) continue;
            const std::vector<float>& weights = rows.patterns()[rows.pattern_of(row)].normalised;
            const Index* columns = rows.columns(row);
            float sum = u[row];
            for (std::size_t k = 0; k < weights.size(); ++k) sum += std::abs(weights[k]) * u[columns[k]];
            next[row] = 0.5F * sum;  // any scale will do; this one keeps the numbers near 1
            ratio = std::max(ratio, static_cast<double>(sum) / static_cast<double>(u[row]));
          }
          return ratio;
        },
        [](double a, double b) { return std::max(a, b); });
    bound = step == 0 ? most : std::min(bound, most);
    std::swap(u, next);
  }
  return bound * (1.0 + 1e-5);  // the sums are floats
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
  const auto begin_of = [&](std::ptrdiff_t t) { return static_cast<Index>(rows.free_count() * t / count); };
  // Growing is serial; the bound keeps the other threads busy meanwhile.
  parallel_both([&] { tiling.order = grow_tiles(rows, count, progress_within(progress, 0.0, 0.3)); },
                [&] { tiling.upper_bound = collatz_bound(rows); });
  Buffer<Index> place(static_cast<std::size_t>(rows.size()), -1);
  const auto sort_tile = [&](std::ptrdiff_t t) {
    std::stable_sort(tiling.order.begin() + begin_of(t), tiling.order.begin() + begin_of(t + 1),
                     [&](Index a, Index b) { return rows.pattern_of(a) < rows.pattern_of(b); });
    for (Index i = begin_of(t); i < begin_of(t + 1); ++i) place[tiling.order[i]] = i;
  };
  parallel_for_each(count, sort_tile, progress_within(progress, 0.3, 0.4));
  tiling.tiles.resize(static_cast<std::size_t>(count));
  for (Index t = 0; t < count; ++t) {
    tiling.tiles[t].first = begin_of(t);
    tiling.tiles[t].own_count = begin_of(t + 1) - begin_of(t);
  }
  if (!build_tiles(rows, place, tiling, progress_within(progress, 0.4, 1.0))) {
    tiling.tiles.clear();
    tiling.overlap = std::numeric_limits<double>::infinity();
    return tiling;
  }
  tiling.held = rows.held();
  for (HeldEntry& entry : tiling.held) entry.row = place[entry.row];
  double locals = 0.0;
  for (const Tile& tile : tiling.tiles) locals += tile.ring_end.back();
  tiling.overlap = count > 0 ? locals / rows.free_count() : 1.0;
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

void tile_remainder(const Tile& tile, const std::vector<RowPattern>& patterns, int last_ring, const Double4* x,
                    Double4* remainder) {
  for (Index s = 0; s < tile.segment_end[last_ring]; ++s) {
    const TileSegment& segment = tile.segments[s];
    const RowPattern& pattern = patterns[segment.pattern];
    remainder_for(pattern.weights.size())(segment, pattern, tile.columns.data() + segment.first_column, x, remainder);
  }
}

}  // namespace batten
