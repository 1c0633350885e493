#include "batten/volume/points_mask.h"

#include <algorithm>
#include <cmath>

#include "batten/error.h"
#include "batten/mesh/checked_values.h"
#include "batten/volume/distance_transform.h"
#include "batten/volume/label_mask.h"
#include "batten/volume/rolling_ball.h"

namespace batten {

Volume points_mask(const Points& points, Index cells) {
  constexpr double kLargest = 0.5;  // of the box's diagonal
  constexpr double kOfLargest = 0.5;
  constexpr double kGrowth = 1.2;
  constexpr double kSafe = 2.0;
  constexpr Index kMargin = 3;
  require_finite(points, "points");
  if (points.rows() < 6) throw Error(ErrorCode::BadArgument, "six points or more on the surface");
  if (cells < 8 || cells > 256) throw Error(ErrorCode::BadArgument, "a grid of 8 to 256 cells along a side");
  const Eigen::RowVector3d low = points.colwise().minCoeff();
  const Eigen::RowVector3d high = points.colwise().maxCoeff();
  const double diagonal = (high - low).norm();
  if (!((high - low).minCoeff() > 1e-6 * diagonal))
    throw Error(ErrorCode::BadArgument, "the points lie in a plane; give some across it");
  const double cell = (high - low).maxCoeff() / cells;
  const double largest = kLargest * diagonal;
  Volume mask;
  mask.grid.axes *= cell;
  const auto margin = kMargin + static_cast<Index>(std::ceil(largest / cell));
  mask.grid.origin = low.transpose() - Eigen::Vector3d::Constant(margin * cell);
  for (int c = 0; c < 3; ++c)
    mask.grid.size[c] = static_cast<Index>(std::ceil((high(c) - low(c)) / cell)) + 1 + 2 * margin;
  VoxelFlags seeds(static_cast<std::size_t>(mask.grid.count()), 0);
  const Points indices = mask.grid.to_indices(points);
  for (Eigen::Index row = 0; row < points.rows(); ++row) {
    const Eigen::RowVector3d at = indices.row(row).array().round();
    seeds[mask.grid.voxel(static_cast<Index>(at(0)), static_cast<Index>(at(1)), static_cast<Index>(at(2)))] = 1;
  }
  const Buffer<float> distances = distance_transform(mask.grid, seeds);
  const auto most =
      static_cast<double>(count_of(largest_piece(mask.grid, enclosed_by_ball(mask.grid, distances, largest))));
  double radius = 1.5 * cell;
  while (radius < largest && static_cast<double>(count_of(largest_piece(
                                 mask.grid, enclosed_by_ball(mask.grid, distances, radius)))) < kOfLargest * most)
    radius *= kGrowth;
  const VoxelFlags inside =
      largest_piece(mask.grid, enclosed_by_ball(mask.grid, distances, std::min(largest, kSafe * radius)));
  if (count_of(inside) == 0)
    throw Error(ErrorCode::BadArgument, "the points enclose nothing; give more points around the part");
  mask.values.resize(inside.size());
  for (std::size_t i = 0; i < inside.size(); ++i) mask.values[i] = inside[i] != 0 ? 1.0F : 0.0F;
  return label_mask(mask, {});
}

}  // namespace batten
