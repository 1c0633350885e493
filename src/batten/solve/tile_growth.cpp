#include "batten/solve/tile_growth.h"

namespace batten {

namespace {

// Rows to prefetch ahead: memory answers in the time of about a dozen.
constexpr Index kPlacesAhead = 24;
constexpr Index kColumnsAhead = 12;

}  // namespace

TileGrowth::TileGrowth(const RowTable& rows, Index tile_count)
    : rows_(rows), tile_count_(tile_count), taken_(static_cast<std::size_t>(rows.size()), 0) {}

void TileGrowth::grow_next(Buffer<Index>& order) {
  Index head = begin_of(tile_);
  Index count = head;
  const Index target = begin_of(++tile_);
  while (count < target) {
    if (head == count) {
      const Index seed = next_seed();
      taken_[seed] = 1;
      order[count++] = seed;
      continue;
    }
    if (head + kPlacesAhead < count) rows_.prefetch_place(order[head + kPlacesAhead]);
    if (head + kColumnsAhead < count) rows_.prefetch_columns(order[head + kColumnsAhead]);
    count = take_neighbours(order[head++], count, target, order);
  }
  remember_rim(head, target, order);
}

/// A row beside an earlier tile, or any free row.
Index TileGrowth::next_seed() {
  while (seed_ < seeds_.size() && taken_[seeds_[seed_]] != 0) ++seed_;
  if (seed_ < seeds_.size()) return seeds_[seed_];
  while (taken_[scan_] != 0 || !rows_.is_free(scan_)) ++scan_;
  return scan_;
}

/// Takes the row's columns that nobody took yet, up to `target` rows in all; returns how many there are then.
Index TileGrowth::take_neighbours(Index row, Index count, Index target, Buffer<Index>& order) {
  const Index* columns = rows_.columns(row);
  const Index column_count = rows_.column_count(row);
  if (count + column_count <= target) {
    // Whether a column is taken is anybody's guess, so it is written in any case and counted where it is new.
    for (Index i = 0; i < column_count; ++i) {
      const Index column = columns[i];
      order[count] = column;
      count += taken_[column] == 0 ? 1 : 0;
      taken_[column] = 1;
    }
    return count;
  }
  for (Index i = 0; i < column_count && count < target; ++i) {
    if (taken_[columns[i]] != 0) continue;
    taken_[columns[i]] = 1;
    order[count++] = columns[i];
  }
  return count;
}

/// Keeps what the last rows of a full tile touch as seeds of the tiles to come.
void TileGrowth::remember_rim(Index first, Index last, const Buffer<Index>& order) {
  for (Index i = first; i < last; ++i) {
    const Index* columns = rows_.columns(order[i]);
    for (Index k = 0; k < rows_.column_count(order[i]); ++k) {
      if (taken_[columns[k]] == 0) seeds_.push_back(columns[k]);
    }
  }
}

}  // namespace batten
