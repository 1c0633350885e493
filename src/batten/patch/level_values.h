/// \file Control values for the pieces of all levels.
#pragma once
#include <vector>

#include "batten/double4.h"
#include "batten/patch/pieces.h"
#include "batten/patch/surface_patches.h"

namespace batten {

/// Control values for the pieces of all levels.
class LevelValues {
 public:
  LevelValues(const Pieces& pieces, ConstValuesRef base);
  ConstValuesRef at(int level) const { return level == 0 ? base_ : refined_[level - 1]; }

 private:
  Eigen::Ref<const Values, 0, Eigen::OuterStride<>> base_;
  std::vector<Eigen::Ref<const Values, 0, Eigen::OuterStride<>>> refined_;
  std::vector<Values> storage_;
};

/// Rows of three numbers with a fourth, which is zero. Threaded.
Buffer<Double4> vectors_of(ConstValuesRef points);

/// Control points for the pieces of all levels. base: those of the base.
std::vector<Buffer<Double4>> level_points(const SurfacePatches& patches, ConstValuesRef base);

}  // namespace batten
