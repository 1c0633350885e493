/// \file When a front that starts at a voxel reaches the others.
#pragma once
#include <vector>

#include "batten/volume/volume.h"

namespace batten {

/// What a front does.
struct Front {
  Buffer<float> times;                ///< at each voxel; infinite where the front did not come
  std::vector<std::ptrdiff_t> order;  ///< the voxels in the order in which it came
};

/// Solves |grad T| = cost, T = 0 at the start, by fast marching (Sethian 1996, key S96). costs: what a millimetre costs
/// at each voxel, positive; infinite ones are not entered. The axes are taken to be at right angles. O(n log n).
Front march_front(const VolumeGrid& grid, const Buffer<float>& costs, std::ptrdiff_t start);

}  // namespace batten
