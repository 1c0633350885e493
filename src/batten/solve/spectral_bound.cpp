#include "batten/solve/spectral_bound.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "batten/parallel/parallel.h"

namespace batten {

namespace {

constexpr int kBoundSteps = 4;
static_assert(kBoundSteps < Tile::kRings, "a tile needs a ring for each step");

/// The largest ratio of each step.
using Ratios = std::array<double, kBoundSteps>;

/// One tile's vectors.
struct PowerScratch {
  Buffer<float> u;
  Buffer<float> next;

  std::size_t size() const { return u.size(); }
  void resize(std::size_t count) {
    u.resize(count);
    next.resize(count);
  }
};

/// next = |D^-1 A| u on the rows of rings 0 .. last_ring; returns the largest ratio of the tile's own rows.
double power_step(const Tiling& tiling, const Tile& tile, int last_ring, const float* u, float* next) {
  double most = 0.0;
  for (Index s = 0; s < tile.segment_end[last_ring]; ++s) {
    const TileSegment& segment = tile.segments[s];
    const std::vector<float>& weights = tiling.patterns[segment.pattern].normalised;
    const std::uint16_t* columns = tile.columns.data() + segment.first_column;
    const Index last = segment.first_row + segment.row_count;
    for (Index row = segment.first_row; row < last; ++row, columns += weights.size()) {
      float sum = u[row];
      for (std::size_t k = 0; k < weights.size(); ++k) sum += std::abs(weights[k]) * u[columns[k]];
      next[row] = 0.5F * sum;  // any scale will do; this one keeps the numbers near 1
      if (s < tile.segment_end[0]) most = std::max(most, static_cast<double>(sum) / static_cast<double>(u[row]));
    }
  }
  return most;
}

/// The step from u = 1, in which the rows of a segment do not differ.
double first_step(const Tiling& tiling, const Tile& tile, int last_ring, float* next) {
  double most = 0.0;
  for (Index s = 0; s < tile.segment_end[last_ring]; ++s) {
    const TileSegment& segment = tile.segments[s];
    float sum = 1.0F;
    for (const float weight : tiling.patterns[segment.pattern].normalised) sum += std::abs(weight);
    std::fill_n(next + segment.first_row, segment.row_count, 0.5F * sum);
    if (s < tile.segment_end[0]) most = std::max(most, static_cast<double>(sum));
  }
  return most;
}

Ratios tile_ratios(const Tiling& tiling, const Tile& tile) {
  PowerScratch& scratch = scratch_for<PowerScratch>(tile);
  Ratios ratios;
  ratios[0] = first_step(tiling, tile, kBoundSteps - 1, scratch.u.data());
  for (int step = 1; step < kBoundSteps; ++step) {
    ratios[step] = power_step(tiling, tile, kBoundSteps - 1 - step, scratch.u.data(), scratch.next.data());
    std::swap(scratch.u, scratch.next);
  }
  return ratios;
}

}  // namespace

double spectral_bound(const Tiling& tiling) {
  const Ratios ratios = parallel_reduce(
      static_cast<std::ptrdiff_t>(tiling.tiles.size()), Ratios{},
      [&](std::ptrdiff_t t, std::ptrdiff_t /*end*/) { return tile_ratios(tiling, tiling.tiles[t]); },
      [](Ratios left, const Ratios& right) {
        for (int step = 0; step < kBoundSteps; ++step) left[step] = std::max(left[step], right[step]);
        return left;
      },
      1);
  return *std::min_element(ratios.begin(), ratios.end()) * (1.0 + 1e-5);  // the sums are floats
}

}  // namespace batten
