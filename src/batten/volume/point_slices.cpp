#include "batten/volume/point_slices.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numeric>

#include "batten/fit/point_tree.h"
#include "batten/mesh/checked_values.h"
#include "batten/quantile.h"

namespace batten {

namespace {

/// Ways from points to others of the same slice, or so it is hoped.
struct Ways {
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  std::vector<double> lengths;
};

/// From each point to its two nearest others.
Ways ways_to_neighbours(const Points& points) {
  constexpr Index kNear = 2;
  const PointTree tree(points);
  const NeighbourTable near = find_neighbours(tree, kNear);
  Ways ways;
  for (Index row = 0; row < tree.size(); ++row) {
    for (Index k = 0; k < kNear; ++k) {
      const Index other = near.point(row, k);
      if (other < 0 || !(near.distance(row, k) > 0.0)) continue;
      const Eigen::RowVector3d way = (points.row(other) - points.row(row)).normalized();
      ways.squares += way.transpose() * way;
      ways.lengths.push_back(near.distance(row, k));
    }
  }
  return ways;
}

/// Axes whose last one is across most of the ways, or nothing where they lie in no plane or on a line.
std::optional<Eigen::Matrix3d> axes_of(const Eigen::Matrix3d& squares) {
  constexpr double kFlat = 0.02;  // a few ways may lead to other slices
  constexpr double kWide = 0.02;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solved(squares);
  const Eigen::Vector3d shares = solved.eigenvalues() / std::max(squares.trace(), std::numeric_limits<double>::min());
  if (!(shares[0] <= kFlat && shares[1] >= kWide)) return {};
  const Eigen::Vector3d normal = solved.eigenvectors().col(0);
  const Eigen::Vector3d along = solved.eigenvectors().col(2);
  Eigen::Matrix3d axes;
  axes << along, normal.cross(along), normal;
  return axes;
}

/// Rows in the order of their heights, parted where the next is higher by more than `gap`.
std::vector<std::vector<Eigen::Index>> parted(const Scalars& heights, double gap) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(heights.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return heights[a] < heights[b]; });
  std::vector<std::vector<Eigen::Index>> parts;
  for (const Eigen::Index row : order) {
    if (parts.empty() || heights[row] - heights[parts.back().back()] > gap) parts.emplace_back();
    parts.back().push_back(row);
  }
  for (std::vector<Eigen::Index>& part : parts) std::sort(part.begin(), part.end());
  return parts;
}

}  // namespace

std::optional<PointSlices> find_slices(const Points& points) {
  constexpr double kThin = 0.25;   // of the distance of neighbours
  constexpr double kFewest = 6.0;  // points a slice, in the mean
  require_finite(points, "points");
  Ways ways = ways_to_neighbours(points);
  std::optional<Eigen::Matrix3d> axes = axes_of(ways.squares);
  if (!axes) return {};
  const double spacing = quantile(ways.lengths, 0.5);
  PointSlices slices;
  slices.rows = parted(points * axes->col(2), kThin * spacing);
  const auto are_many = [&] {
    return static_cast<double>(points.rows()) < kFewest * static_cast<double>(slices.rows.size());
  };
  if (are_many()) return {};
  // Once more by whole slices, which are longer than neighbours are apart.
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const std::vector<Eigen::Index>& rows : slices.rows) {
    const Points here = points(rows, Eigen::all);
    const Points from = here.rowwise() - here.colwise().mean();
    squares += from.transpose() * from;
  }
  axes = axes_of(squares);
  if (!axes) return {};
  slices.axes = *axes;
  const Scalars heights = points * slices.axes.col(2);
  slices.rows = parted(heights, kThin * spacing);
  if (slices.rows.size() < 2 || are_many()) return {};
  std::vector<double> steps;
  for (const std::vector<Eigen::Index>& rows : slices.rows) {
    const Scalars here = heights(rows);
    if (here.maxCoeff() - here.minCoeff() > kThin * spacing) return {};
    if (!slices.levels.empty()) steps.push_back(here.mean() - slices.levels.back());
    slices.levels.push_back(here.mean());
  }
  if (spacing > quantile(steps, 0.5)) return {};
  return slices;
}

}  // namespace batten
