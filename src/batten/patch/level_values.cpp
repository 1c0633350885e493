#include "batten/patch/level_values.h"

#include "batten/parallel/parallel.h"

namespace batten {

LevelValues::LevelValues(const Pieces& pieces, ConstValuesRef base) : base_(base) {
  storage_.reserve(static_cast<std::size_t>(pieces.region_count()));
  for (int level = 1; level <= pieces.region_count(); ++level) {
    storage_.push_back(pieces.refine(level, at(level - 1)));
    refined_.emplace_back(storage_.back());
  }
}

Buffer<Double4> vectors_of(ConstValuesRef points) {
  Buffer<Double4> vectors(static_cast<std::size_t>(points.rows()));
  parallel_for(points.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) vectors[i] = Double4{points(i, 0), points(i, 1), points(i, 2), 0.0};
  });
  return vectors;
}

std::vector<Buffer<Double4>> level_points(const SurfacePatches& patches, ConstValuesRef base) {
  const LevelValues values(patches.pieces(), base);
  std::vector<Buffer<Double4>> points;
  for (int level = 0; level <= patches.pieces().region_count(); ++level) points.push_back(vectors_of(values.at(level)));
  return points;
}

}  // namespace batten
