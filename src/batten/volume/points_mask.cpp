#include "batten/volume/points_mask.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "batten/error.h"
#include "batten/fit/point_tree.h"
#include "batten/mesh/checked_values.h"
#include "batten/quantile.h"
#include "batten/volume/label_mask.h"
#include "batten/volume/rolling_ball.h"

namespace batten {

Volume points_mask(const Points& points, Index cells) {
  constexpr double kLargest = 0.5;  // of the box's diagonal
  constexpr double kOfLargest = 0.5;
  constexpr double kGrowth = 1.2;
  constexpr double kSafe = 2.0;
  require_finite(points, "points");
  if (points.rows() < 6)
    throw Error(ErrorCode::BadArgument,
                "a surface starts from six points on it or more; there are " + std::to_string(points.rows()));
  if (cells < 8 || cells > 256) throw Error(ErrorCode::BadArgument, "a grid of 8 to 256 cells along a side");
  const Eigen::RowVector3d low = points.colwise().minCoeff();
  const Eigen::RowVector3d high = points.colwise().maxCoeff();
  const double diagonal = (high - low).norm();
  if (!((high - low).minCoeff() > 1e-6 * diagonal))
    throw Error(ErrorCode::BadArgument, "the points lie in a plane; give some across it");
  const double largest = kLargest * diagonal;
  const PointDistances near = distances_to_points(points, cells, largest);
  const VolumeGrid& grid = near.grid;
  const auto enclosed = [&](double radius) {
    return largest_piece(grid, enclosed_by_ball(grid, near.distances, radius));
  };
  const auto most = static_cast<double>(count_of(enclosed(largest)));
  double radius = 1.5 * grid.spacing(0);
  while (radius < largest && static_cast<double>(count_of(enclosed(radius))) < kOfLargest * most) radius *= kGrowth;
  const VoxelFlags inside = enclosed(std::min(largest, kSafe * radius));
  if (count_of(inside) == 0)
    throw Error(ErrorCode::BadArgument, "the points enclose nothing; give more points around the part");
  Volume mask;
  mask.grid = grid;
  mask.values.resize(inside.size());
  for (std::size_t i = 0; i < inside.size(); ++i) mask.values[i] = inside[i] != 0 ? 1.0F : 0.0F;
  return label_mask(mask, {});
}

std::vector<Eigen::Index> points_outside_gaps(const Points& points) {
  constexpr double kRadius = 1.5;  // of the median distance between neighbours
  constexpr double kDepth = 0.35;
  constexpr double kCells = 4.0;  // a distance between neighbours
  constexpr Index kFewest = 60;
  constexpr Index kMost = 96;
  require_finite(points, "points");
  std::vector<Eigen::Index> rows(static_cast<std::size_t>(points.rows()));
  std::iota(rows.begin(), rows.end(), Eigen::Index{0});
  const PointTree tree(points);
  const NeighbourTable beside = find_neighbours(tree, 1);
  std::vector<double> apart;
  for (Index row = 0; row < tree.size(); ++row) {
    if (beside.point(row, 0) >= 0 && beside.distance(row, 0) > 0.0) apart.push_back(beside.distance(row, 0));
  }
  if (apart.empty()) return rows;
  const double spacing = quantile(apart, 0.5);
  const double longest = (points.colwise().maxCoeff() - points.colwise().minCoeff()).maxCoeff();
  if (kCells * longest > kMost * spacing) return rows;
  const auto cells = std::max(kFewest, static_cast<Index>(std::ceil(kCells * longest / spacing)));
  const PointDistances near = distances_to_points(points, cells, kRadius * spacing);
  const Buffer<float> from_ball = distances_from_ball(near.grid, near.distances, kRadius * spacing);
  std::erase_if(rows, [&](Eigen::Index row) { return from_ball[near.voxels[row]] > (kRadius + kDepth) * spacing; });
  return rows;
}

}  // namespace batten
