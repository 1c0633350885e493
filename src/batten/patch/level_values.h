/// \file Control values for the pieces of all levels.
#pragma once
#include <vector>

#include "batten/patch/pieces.h"

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

}  // namespace batten
