#include "batten/volume/points_mask.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "batten/error.h"
#include "batten/mesh/checked_values.h"
#include "batten/volume/distance_transform.h"
#include "batten/volume/label_mask.h"

namespace batten {

namespace {

using Flags = Buffer<std::uint8_t>;

/// Calls visit for the voxels beside one that share a face with it.
template <typename Visit>
void for_each_beside(const VolumeGrid& grid, std::ptrdiff_t voxel, const Visit& visit) {
  const std::ptrdiff_t row = grid.size[0];
  const std::ptrdiff_t slice = row * grid.size[1];
  if (voxel % row > 0) visit(voxel - 1);
  if (voxel % row < row - 1) visit(voxel + 1);
  if (voxel % slice >= row) visit(voxel - row);
  if (voxel % slice < slice - row) visit(voxel + row);
  if (voxel >= slice) visit(voxel - slice);
  if (voxel < grid.count() - slice) visit(voxel + slice);
}

/// Gives `mark` to the voxels joined to `start` by voxels that are `open` and have no mark yet; returns how many.
template <typename Open>
std::ptrdiff_t flood(const VolumeGrid& grid, std::ptrdiff_t start, const Open& open, Index mark, Buffer<Index>& marks) {
  if (marks[start] != 0 || !open(start)) return 0;
  std::vector<std::ptrdiff_t> waiting{start};
  marks[start] = mark;
  std::ptrdiff_t count = 0;
  while (!waiting.empty()) {
    const std::ptrdiff_t voxel = waiting.back();
    waiting.pop_back();
    ++count;
    for_each_beside(grid, voxel, [&](std::ptrdiff_t next) {
      if (marks[next] != 0 || !open(next)) return;
      marks[next] = mark;
      waiting.push_back(next);
    });
  }
  return count;
}

/// The voxels that no ball of the radius reaches whose centre comes from the first voxel. distances: to the points.
Flags enclosed(const VolumeGrid& grid, const Buffer<float>& distances, double radius) {
  Buffer<Index> marks(static_cast<std::size_t>(grid.count()), 0);
  flood(
      grid, 0, [&](std::ptrdiff_t voxel) { return distances[voxel] > radius; }, 1, marks);
  const Flags centres(marks.begin(), marks.end());
  const Buffer<float> from_centres = distance_transform(grid, centres);
  Flags inside(centres.size());
  for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = from_centres[i] > radius ? 1 : 0;
  return inside;
}

double count_of(const Flags& flags) { return static_cast<double>(std::count(flags.begin(), flags.end(), 1)); }

/// The largest piece alone.
Flags largest_piece(const VolumeGrid& grid, const Flags& flags) {
  Buffer<Index> marks(flags.size(), 0);
  Index pieces = 0;
  Index best = 0;
  std::ptrdiff_t most = 0;
  for (std::ptrdiff_t i = 0; i < grid.count(); ++i) {
    const auto count = flood(
        grid, i, [&](std::ptrdiff_t voxel) { return flags[voxel] != 0; }, pieces + 1, marks);
    if (count > 0) ++pieces;
    if (count <= most) continue;
    most = count;
    best = pieces;
  }
  Flags piece(flags.size());
  for (std::size_t i = 0; i < piece.size(); ++i) piece[i] = most > 0 && marks[i] == best ? 1 : 0;
  return piece;
}

}  // namespace

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
  Flags seeds(static_cast<std::size_t>(mask.grid.count()), 0);
  const Points indices = mask.grid.to_indices(points);
  for (Eigen::Index row = 0; row < points.rows(); ++row) {
    const Eigen::RowVector3d at = indices.row(row).array().round();
    seeds[mask.grid.voxel(static_cast<Index>(at(0)), static_cast<Index>(at(1)), static_cast<Index>(at(2)))] = 1;
  }
  const Buffer<float> distances = distance_transform(mask.grid, seeds);
  const double most = count_of(largest_piece(mask.grid, enclosed(mask.grid, distances, largest)));
  double radius = 1.5 * cell;
  while (radius < largest &&
         count_of(largest_piece(mask.grid, enclosed(mask.grid, distances, radius))) < kOfLargest * most)
    radius *= kGrowth;
  const Flags inside = largest_piece(mask.grid, enclosed(mask.grid, distances, std::min(largest, kSafe * radius)));
  if (count_of(inside) == 0.0)
    throw Error(ErrorCode::BadArgument, "the points enclose nothing; give more points around the part");
  mask.values.resize(inside.size());
  for (std::size_t i = 0; i < inside.size(); ++i) mask.values[i] = inside[i] != 0 ? 1.0F : 0.0F;
  return label_mask(mask, {});
}

}  // namespace batten
