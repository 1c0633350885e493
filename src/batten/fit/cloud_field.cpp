#include "batten/fit/cloud_field.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "batten/fit/field_grid.h"
#include "batten/fit/winding_field.h"
#include "batten/parallel/parallel.h"
#include "batten/quantile.h"

namespace batten {

namespace {

constexpr double kUsualCells = 80.0;
constexpr double kMostCells = 200.0;
constexpr double kMargin = 0.12;
constexpr double kWidthShare = 0.6;
constexpr Index kPlaceNeighbours = 10;

/// The winding number that the median sample has.
double level_on_samples(const CloudSamples& samples, const WindingField& field) {
  std::vector<double> values(static_cast<std::size_t>(samples.points.rows()));
  parallel_for(
      samples.points.rows(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (std::ptrdiff_t row = begin; row < end; ++row) values[row] = field.value(samples.points.row(row));
      },
      256);
  return quantile(values, 0.5);
}

/// The normals of samples turned to where the field of all falls, each time on a finer scale: what most of them say of
/// the sides puts the others right (Lin, Shi and Liu 2024, key LSL24, who start from any normals).
Points turned_normals(const CloudSamples& samples) {
  constexpr int kRounds = 4;
  constexpr double kFirstWidth = 3.0;
  Points normals = samples.normals;
  for (int round = 0; round < kRounds; ++round) {
    const double width = kFirstWidth + (kWidthShare - kFirstWidth) * round / (kRounds - 1);
    const WindingField field(samples.points, normals, samples.areas, width * samples.spacing);
    parallel_for(
        normals.rows(),
        [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          for (std::ptrdiff_t row = begin; row < end; ++row) {
            const Eigen::RowVector3d fall = field.fall(samples.points.row(row));
            const double length = fall.norm();
            if (length > 0.0) normals.row(row) = fall / length;
          }
        },
        256);
  }
  return normals;
}

/// Normals on the side of the turned ones, which take the place of those at a right angle to them.
void take_sides(CloudSamples& samples, const Points& turned) {
  constexpr double kUpright = 0.3;
  for (Eigen::Index row = 0; row < turned.rows(); ++row) {
    const double along = samples.normals.row(row).dot(turned.row(row));
    if (std::abs(along) < kUpright) {
      samples.normals.row(row) = turned.row(row);
    } else if (along < 0.0) {
      samples.normals.row(row) *= -1.0;
    }
  }
}

}  // namespace

CloudField::CloudField(CloudSamples prepared, Index vertices, const Progress& progress)
    : samples(std::move(prepared)), tree(samples.points) {
  const Points turned = turned_normals(samples);
  take_sides(samples, turned);
  const WindingField field(samples.points, turned, samples.areas, kWidthShare * samples.spacing);
  level = level_on_samples(samples, field);
  const double for_vertices = 0.5 * std::sqrt(samples.areas.sum() / vertices);
  const double finest = std::clamp(for_vertices, 1.0 / kMostCells, 1.0 / kUsualCells);
  const double spacing = std::max(0.7 * samples.typical, finest);
  const double margin = std::max(kMargin, 3.0 * spacing);
  const Eigen::RowVector3d low = samples.points.colwise().minCoeff().array() - margin;
  const Eigen::RowVector3d high = samples.points.colwise().maxCoeff().array() + margin;
  grid = grid_over(low, high, spacing);
  fill_from_field(grid, field, level, samples.points, progress);
}

Eigen::RowVector3d CloudField::nearest_place(const Eigen::RowVector3d& place, const Eigen::RowVector3d& normal) const {
  Index near[kPlaceNeighbours];
  double squares[kPlaceNeighbours];
  const Index found = tree.nearest(place, kPlaceNeighbours, near, squares);
  const double width = found > 0 ? std::max(samples.spacing(near[0]), std::sqrt(squares[0])) : 0.0;
  Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
  Eigen::RowVector3d mean_normal = Eigen::RowVector3d::Zero();
  double sum = 0.0;
  for (Index k = 0; k < found; ++k) {
    if (samples.normals.row(near[k]).dot(normal) < 0.0) continue;
    const double weight = std::exp(-squares[k] / (width * width));
    mean += weight * samples.points.row(near[k]);
    mean_normal += weight * samples.normals.row(near[k]);
    sum += weight;
  }
  const double length = mean_normal.norm();
  if (sum > 0.0 && length > 0.2 * sum && std::sqrt(squares[0]) < 4.0 * samples.spacing(near[0])) {
    mean /= sum;
    mean_normal /= length;
    return place + mean_normal * (mean - place).dot(mean_normal);
  }
  // Newton's step on the field along its slope, at most one cell.
  const double h = grid.spacing;
  Eigen::RowVector3d slope;
  for (Eigen::Index c = 0; c < 3; ++c) {
    const Eigen::RowVector3d step = h * Eigen::RowVector3d::Unit(c);
    slope(c) = (grid.at(place + step) - grid.at(place - step)) / (2.0 * h);
  }
  const double square = slope.squaredNorm();
  if (!(square > 0.0)) return place;
  Eigen::RowVector3d move = -grid.at(place) / square * slope;
  const double far = move.norm();
  if (far > h) move *= h / far;
  return place + move;
}

}  // namespace batten
