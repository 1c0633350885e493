#include "batten/volume/rolling_ball.h"

#include "batten/volume/distance_transform.h"

namespace batten {

Buffer<float> distances_from_ball(const VolumeGrid& grid, const Buffer<float>& distances, double radius) {
  Buffer<Index> marks(static_cast<std::size_t>(grid.count()), 0);
  flood(
      grid, 0, [&](std::ptrdiff_t voxel) { return distances[voxel] > radius; }, 1, marks);
  return distance_transform(grid, VoxelFlags(marks.begin(), marks.end()));
}

VoxelFlags enclosed_by_ball(const VolumeGrid& grid, const Buffer<float>& distances, double radius) {
  const Buffer<float> from_centres = distances_from_ball(grid, distances, radius);
  VoxelFlags inside(from_centres.size());
  for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = from_centres[i] > radius ? 1 : 0;
  return inside;
}

}  // namespace batten
