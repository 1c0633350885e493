#include "batten/solve/tile_builder.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "batten/parallel/parallel.h"

namespace batten {

namespace {

constexpr Index kAhead = 12;  // rows to prefetch ahead: memory answers in the time of about so many

/// Sorts items by pattern, equal ones as they stand. Nearly all tiles have a handful of patterns, which are counted.
/// pattern_of: of each item, in their order. spare: memory.
void sort_stably(Index* items, Index count, const Index* pattern_of, Buffer<Index>& spare) {
  constexpr std::size_t kFew = 12;
  std::array<Index, kFew> patterns;
  std::array<Index, kFew> counts{};
  std::size_t distinct = 0;
  std::size_t last = 0;
  for (Index i = 0; i < count && distinct <= kFew; ++i) {
    if (distinct == 0 || patterns[last] != pattern_of[i]) {
      last = static_cast<std::size_t>(std::find(patterns.begin(), patterns.begin() + distinct, pattern_of[i]) -
                                      patterns.begin());
      if (last == kFew) {
        distinct = kFew + 1;
        break;
      }
      if (last == distinct) patterns[distinct++] = pattern_of[i];
    }
    ++counts[last];
  }
  if (distinct <= 1) return;
  spare.resize(static_cast<std::size_t>(count));
  if (distinct > kFew) {
    std::iota(spare.begin(), spare.end(), 0);
    std::stable_sort(spare.begin(), spare.end(), [&](Index a, Index b) { return pattern_of[a] < pattern_of[b]; });
    for (Index& item : spare) item = items[item];
  } else {
    std::array<Index, kFew> begins{};
    for (std::size_t a = 0; a < distinct; ++a) {
      for (std::size_t b = 0; b < distinct; ++b) begins[a] += patterns[b] < patterns[a] ? counts[b] : 0;
    }
    for (Index i = 0; i < count; ++i) {
      if (patterns[last] != pattern_of[i]) {
        last = static_cast<std::size_t>(std::find(patterns.begin(), patterns.begin() + distinct, pattern_of[i]) -
                                        patterns.begin());
      }
      spare[begins[last]++] = items[i];
    }
  }
  std::copy(spare.begin(), spare.end(), items);
}

}  // namespace

void LocalPlaces::clear(Index row_count) {
  for (const Index row : rows_) directory_[row >> kPageBits] = 0;
  rows_.clear();
  pages_.assign(kPageRows, kMost);
  const auto runs = static_cast<std::size_t>(block_count(row_count, kPageRows));
  if (directory_.size() < runs) directory_.assign(runs, 0);
}

Index LocalPlaces::add(Index row) {
  const Index place = count();
  if (place == kMost) return kMost;
  std::uint16_t& page = directory_[row >> kPageBits];
  if (page == 0) {
    page = static_cast<std::uint16_t>(pages_.size() / kPageRows);
    pages_.resize(pages_.size() + kPageRows, kMost);
  }
  pages_[slot_of(row)] = static_cast<std::uint16_t>(place);
  rows_.push_back(row);
  return place;
}

bool TileBuilder::build(const RowTable& rows, Index* own, Tile& tile) {
  sort_by_pattern(rows, own, tile.own_count, own);
  places_.clear(rows.size());
  for (Index i = 0; i < tile.own_count; ++i) places_.find_or_add(own[i]);
  if (!add_rings(rows, tile)) return false;
  sort_rings(rows, tile);
  write_rows(rows, tile);
  tile.ghosts.resize(sorted_.size() - static_cast<std::size_t>(tile.own_count));
  for (std::size_t i = 0; i < tile.ghosts.size(); ++i) tile.ghosts[i] = places_.rows()[sorted_[tile.own_count + i]];
  return true;
}

/// row_of: of each of the `count` items from `first` on.
void TileBuilder::sort_by_pattern(const RowTable& rows, Index* first, Index count, const Index* row_of) {
  patterns_.resize(static_cast<std::size_t>(count));
  for (Index i = 0; i < count; ++i) patterns_[i] = rows.pattern_of(row_of[i]);
  sort_stably(first, count, patterns_.data(), spare_);
}

/// Meets ring after ring; entries_ collects the columns of all rows but the last ring's, as places.
bool TileBuilder::add_rings(const RowTable& rows, Tile& tile) {
  tile.ring_end[0] = tile.own_count;
  std::size_t used = 0;
  Index begin = 0;
  for (int ring = 1; ring < Tile::kRings; ++ring) {
    const Index end = tile.ring_end[ring - 1];
    for (Index i = begin; i < end; ++i) {
      if (i + 2 * kAhead < end) rows.prefetch_place(places_.rows()[i + 2 * kAhead]);
      if (i + kAhead < end) rows.prefetch_columns(places_.rows()[i + kAhead]);
      const Index row = places_.rows()[i];
      const Index* columns = rows.columns(row);
      const Index count = rows.column_count(row);
      if (used + count > entries_.size()) entries_.resize(2 * (used + count));
      for (Index k = 0; k < count; ++k) entries_[used + k] = places_.find_or_add(columns[k]);
      used += count;
      if (places_.count() == LocalPlaces::kMost) return false;
    }
    begin = end;
    tile.ring_end[ring] = places_.count();
  }
  return true;
}

/// new_place_: the sorted place of each local unknown; own unknowns are sorted already.
void TileBuilder::sort_rings(const RowTable& rows, const Tile& tile) {
  const Index all = tile.ring_end.back();
  sorted_.resize(static_cast<std::size_t>(all));
  std::iota(sorted_.begin(), sorted_.end(), 0);
  Index begin = tile.own_count;
  for (int ring = 1; ring < Tile::kRings; ++ring) {
    sort_by_pattern(rows, sorted_.data() + begin, tile.ring_end[ring] - begin, places_.rows().data() + begin);
    begin = tile.ring_end[ring];
  }
  new_place_.resize(sorted_.size());
  for (Index i = 0; i < all; ++i) new_place_[sorted_[i]] = static_cast<std::uint16_t>(i);
}

void TileBuilder::write_rows(const RowTable& rows, Tile& tile) {
  const Index with_rows = tile.ring_end[Tile::kRings - 2];
  starts_.resize(static_cast<std::size_t>(with_rows));
  Index start = 0;
  for (Index i = 0; i < with_rows; ++i) {
    starts_[i] = start;
    start += rows.column_count(places_.rows()[i]);
  }
  tile.columns.resize(static_cast<std::size_t>(start));
  std::uint16_t* column = tile.columns.data();
  Index row = 0;
  for (int ring = 0; ring < Tile::kRings; ++ring) {
    const bool has_rows = ring + 1 < Tile::kRings;
    bool fresh = true;
    for (; row < tile.ring_end[ring]; ++row) {
      const Index local = sorted_[row];
      const Index pattern = rows.pattern_of(places_.rows()[local]);
      if (fresh || tile.segments.back().pattern != pattern) {
        tile.segments.push_back({row, 0, pattern, static_cast<Index>(column - tile.columns.data())});
        fresh = false;
      }
      ++tile.segments.back().row_count;
      if (!has_rows) continue;
      const Index count = rows.column_count(places_.rows()[local]);
      const Index* entry = entries_.data() + starts_[local];
      for (Index k = 0; k < count; ++k) *column++ = new_place_[entry[k]];
    }
    tile.segment_end[ring] = static_cast<Index>(tile.segments.size());
  }
}

}  // namespace batten
