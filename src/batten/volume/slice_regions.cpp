#include "batten/volume/slice_regions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "batten/fit/point_tree.h"
#include "batten/volume/distance_transform.h"

namespace batten {

namespace {

/// The places that a disk's centre can be at, in pieces, numbered from 1 on; the first one is outside of all contours.
Index number_pieces(const VolumeGrid& grid, const Buffer<float>& distances, double radius, Buffer<Index>& marks) {
  Index pieces = 0;
  for (std::ptrdiff_t i = 0; i < grid.count(); ++i) {
    if (flood(
            grid, i, [&](std::ptrdiff_t place) { return distances[place] > radius; }, pieces + 1, marks) > 0)
      ++pieces;
  }
  return pieces;
}

/// How many contours lie around each piece; -1 for those that only lead to others through places too narrow for a disk.
std::vector<int> contours_around(const VolumeGrid& grid, const Buffer<Index>& marks, Index pieces, double wall) {
  std::vector<int> around(static_cast<std::size_t>(pieces) + 1, -1);
  around[1] = 0;
  for (int level = 0;; ++level) {
    VoxelFlags here(marks.size(), 0);
    for (std::size_t i = 0; i < here.size(); ++i) here[i] = marks[i] > 0 && around[marks[i]] == level ? 1 : 0;
    if (count_of(here) == 0) return around;
    const Buffer<float> far = distance_transform(grid, here);
    for (std::size_t i = 0; i < here.size(); ++i) {
      if (marks[i] > 0 && around[marks[i]] < 0 && far[i] < wall) around[marks[i]] = level + 1;
    }
  }
}

/// To the nearest point that lies on the other side than `way` leads to, or 0.
double other_way(const Points& points, const NeighbourTable& near, Index row, const Eigen::RowVector3d& way) {
  constexpr double kRight = 0.01;  // corners of a right angle count
  for (Index k = 0; k < near.count && near.point(row, k) >= 0; ++k) {
    const Eigen::RowVector3d other = points.row(near.point(row, k)) - points.row(row);
    if (other.norm() > 0.0 && way.dot(other) <= kRight * way.norm() * other.norm()) return other.norm();
  }
  return 0.0;
}

}  // namespace

std::vector<double> contour_gaps(const std::vector<Points>& planes) {
  constexpr Index kNear = 12;
  std::vector<double> gaps;
  for (const Points& points : planes) {
    const PointTree tree(points);
    const NeighbourTable near = find_neighbours(tree, kNear);
    for (Index row = 0; row < tree.size(); ++row) {
      Index k = 0;
      while (k < kNear && near.point(row, k) >= 0 && !(near.distance(row, k) > 0.0)) ++k;
      if (k == kNear || near.point(row, k) < 0) continue;
      const double gap = other_way(points, near, row, points.row(near.point(row, k)) - points.row(row));
      if (gap > 0.0) gaps.push_back(gap);
    }
  }
  return gaps;
}

VoxelFlags enclosed_in_plane(const VolumeGrid& grid, const Points& points, double radius) {
  constexpr double kCells = 2.5;  // a wall is two radii thick, and as much as whole cells add
  VoxelFlags at(static_cast<std::size_t>(grid.count()), 0);
  const Points indices = grid.to_indices(points);
  for (Eigen::Index row = 0; row < points.rows(); ++row)
    at[grid.voxel(static_cast<Index>(std::lround(indices(row, 0))), static_cast<Index>(std::lround(indices(row, 1))),
                  0)] = 1;
  const Buffer<float> distances = distance_transform(grid, at);
  Buffer<Index> marks(at.size(), 0);
  const Index pieces = number_pieces(grid, distances, radius, marks);
  const std::vector<int> around = contours_around(grid, marks, pieces, 2.0 * radius + kCells * grid.spacing(0));
  VoxelFlags out(at.size(), 0);
  VoxelFlags in(at.size(), 0);
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (marks[i] > 0) (around[marks[i]] % 2 == 1 ? in : out)[i] = 1;
  }
  const Buffer<float> to_out = distance_transform(grid, out);
  const Buffer<float> to_in = distance_transform(grid, in);
  // Where a part is too narrow for a disk inside of it, what disks outside do not touch is inside.
  VoxelFlags inside(at.size());
  for (std::size_t i = 0; i < at.size(); ++i) inside[i] = to_out[i] > std::min<double>(radius, to_in[i]) ? 1 : 0;
  return inside;
}

Buffer<float> signed_distances(const VolumeGrid& grid, const VoxelFlags& inside) {
  VoxelFlags outside(inside.size());
  for (std::size_t i = 0; i < inside.size(); ++i) outside[i] = inside[i] != 0 ? 0 : 1;
  const Buffer<float> to_inside = distance_transform(grid, inside);
  const Buffer<float> to_outside = distance_transform(grid, outside);
  const auto half = static_cast<float>(0.5 * grid.spacing(0));
  Buffer<float> found(inside.size());
  for (std::size_t i = 0; i < found.size(); ++i) found[i] = inside[i] != 0 ? half - to_outside[i] : to_inside[i] - half;
  return found;
}

std::vector<SliceRegion> slice_regions(const VolumeGrid& grid, const VoxelFlags& inside) {
  std::vector<SliceRegion> regions;
  Buffer<Index> marks(inside.size(), 0);
  for (std::ptrdiff_t i = 0; i < grid.count(); ++i) {
    const Index mark = static_cast<Index>(regions.size()) + 1;
    if (flood(
            grid, i, [&](std::ptrdiff_t place) { return inside[place] != 0; }, mark, marks) == 0)
      continue;
    SliceRegion region;
    region.inside.resize(inside.size());
    Index count = 0;
    for (std::size_t n = 0; n < inside.size(); ++n) {
      region.inside[n] = marks[n] == mark ? 1 : 0;
      if (marks[n] != mark) continue;
      const auto place = static_cast<Index>(n);
      region.centre += Eigen::Vector2d(place % grid.size[0], place / grid.size[0]);
      ++count;
    }
    region.centre /= count;
    region.distances = signed_distances(grid, region.inside);
    region.depth = -*std::min_element(region.distances.begin(), region.distances.end());
    regions.push_back(std::move(region));
  }
  return regions;
}

}  // namespace batten
