#include "batten/patch/level_values.h"

namespace batten {

LevelValues::LevelValues(const Pieces& pieces, ConstValuesRef base) : base_(base) {
  storage_.reserve(static_cast<std::size_t>(pieces.region_count()));
  for (int level = 1; level <= pieces.region_count(); ++level) {
    storage_.push_back(pieces.refine(level, at(level - 1)));
    refined_.emplace_back(storage_.back());
  }
}

}  // namespace batten
