/// \file What points enclose, as a ball that rolls around them finds it.
#pragma once
#include "batten/volume/voxel_flood.h"

namespace batten {

/// Where the centre of a ball can be, and the distances of all voxels to these places. distances: of the voxels to the
/// points. The ball comes from the first voxel, which must be open.
Buffer<float> distances_from_ball(const VolumeGrid& grid, const Buffer<float>& distances, double radius);

/// The voxels that the ball does not touch.
VoxelFlags enclosed_by_ball(const VolumeGrid& grid, const Buffer<float>& distances, double radius);

}  // namespace batten
