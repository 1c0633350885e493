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

std::vector<Buffer<Double4>> level_points(const SurfacePatches& patches, ConstValuesRef control,
                                          const Progress& progress) {
  require_control_points(patches.topology(), control);
  const Values base = patches.base_values(control, progress);
  const LevelValues values(patches.pieces(), base);
  std::vector<Buffer<Double4>> points;
  for (int level = 0; level <= patches.pieces().region_count(); ++level) {
    ConstValuesRef from = values.at(level);
    Buffer<Double4>& to = points.emplace_back(static_cast<std::size_t>(from.rows()));
    parallel_for(from.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t i = begin; i < end; ++i) to[i] = Double4{from(i, 0), from(i, 1), from(i, 2), 0.0};
    });
  }
  return points;
}

}  // namespace batten
