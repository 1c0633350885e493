#include "batten/volume/rolling_ball.h"

#include <cmath>

#include "batten/volume/distance_transform.h"

namespace batten {

PointDistances distances_to_points(const Points& points, Index cells, double room) {
  constexpr Index kMargin = 3;
  const Eigen::RowVector3d low = points.colwise().minCoeff();
  const Eigen::RowVector3d high = points.colwise().maxCoeff();
  const double cell = (high - low).maxCoeff() / cells;
  const auto margin = kMargin + static_cast<Index>(std::ceil(room / cell));
  PointDistances found;
  found.grid.axes *= cell;
  found.grid.origin = low.transpose() - Eigen::Vector3d::Constant(margin * cell);
  for (int c = 0; c < 3; ++c)
    found.grid.size[c] = static_cast<Index>(std::ceil((high(c) - low(c)) / cell)) + 1 + 2 * margin;
  VoxelFlags at(static_cast<std::size_t>(found.grid.count()), 0);
  const Points indices = found.grid.to_indices(points);
  for (Eigen::Index row = 0; row < points.rows(); ++row) {
    const Eigen::RowVector3d place = indices.row(row).array().round();
    found.voxels.push_back(
        found.grid.voxel(static_cast<Index>(place(0)), static_cast<Index>(place(1)), static_cast<Index>(place(2))));
    at[found.voxels.back()] = 1;
  }
  found.distances = distance_transform(found.grid, at);
  return found;
}

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
