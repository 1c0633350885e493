/// \file The distance from each voxel to the nearest of some.
#pragma once
#include "batten/volume/volume.h"

namespace batten {

/// In mm, between centres, exact: to the nearest voxel whose flag is not 0; infinite where there is none. The axes must
/// be at right angles. Along one index after the other by lower envelopes of parabolas (Felzenszwalb and Huttenlocher
/// 2012, key FH12): O(voxels), threaded. Throws Error(BadShape, BadArgument).
Buffer<float> distance_transform(const VolumeGrid& grid, const Buffer<std::uint8_t>& flags);

}  // namespace batten
