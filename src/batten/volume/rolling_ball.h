/// \file What points enclose, as a ball that rolls around them finds it.
#pragma once
#include <vector>

#include "batten/volume/voxel_flood.h"

namespace batten {

/// Distances to points on a grid of cubes around them.
struct PointDistances {
  VolumeGrid grid;
  std::vector<std::ptrdiff_t> voxels;  ///< the one that each point lies in
  Buffer<float> distances;             ///< from the centre of each voxel to that of the nearest one with a point, mm
};

/// cells: along the longest side of the points' box. room: to each side of it, mm.
PointDistances distances_to_points(const Points& points, Index cells, double room);

/// Where the centre of a ball can be, and the distances of all voxels to these places. distances: of the voxels to the
/// points. The ball comes from the first voxel, which must be open.
Buffer<float> distances_from_ball(const VolumeGrid& grid, const Buffer<float>& distances, double radius);

/// The voxels that the ball does not touch.
VoxelFlags enclosed_by_ball(const VolumeGrid& grid, const Buffer<float>& distances, double radius);

}  // namespace batten
