#include "batten/fit/cloud_samples.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "batten/error.h"
#include "batten/fit/cloud_boxes.h"
#include "batten/fit/orientation.h"
#include "batten/fit/outliers.h"
#include "batten/mesh/checked_values.h"
#include "batten/mesh/measures.h"
#include "batten/mesh/unit_scale.h"
#include "batten/parallel/parallel.h"
#include "batten/quantile.h"

namespace batten {

namespace {

constexpr Index kFewestPlaces = 20;

/// Too few points, or all on a line.
[[noreturn]] void refuse_cloud() {
  throw Error(ErrorCode::BadArgument, "a first mesh needs points at 20 places or more that are not on one line");
}

/// Brings points into the unit of samples.
Points in_own_unit(const Points& points, CloudSamples& samples) {
  const double scale = unit_scale(points);
  Points scaled = points * scale;
  const BoundingBox box = bounding_box(scaled);
  const Eigen::RowVector3d middle = 0.5 * (box.low + box.high);
  const double size = (box.high - box.low).maxCoeff();
  if (!(size > 1e-12 * box.high.cwiseAbs().cwiseMax(box.low.cwiseAbs()).maxCoeff())) refuse_cloud();
  scaled.rowwise() -= middle;
  scaled /= size;
  samples.centre = middle / scale;
  samples.size = size / scale;
  return scaled;
}

void leave_out(const Buffer<std::uint8_t>& flags, CloudSamples& samples) {
  Index count = 0;
  const bool normals = samples.normals.rows() > 0;
  for (Index row = 0; row < static_cast<Index>(samples.points.rows()); ++row) {
    if (flags[row] != 0) continue;
    samples.points.row(count) = samples.points.row(row);
    if (normals) samples.normals.row(count) = samples.normals.row(row);
    ++count;
  }
  samples.points.conservativeResize(count, 3);
  if (normals) samples.normals.conservativeResize(count, 3);
}

/// Sorts and drops what stands twice. Points at one place keep the mean of their normals.
void sort_cloud(CloudSamples& samples) {
  const Buffer<Index> rows = sorted_rows(samples.points, samples.normals);
  const auto size = static_cast<Index>(rows.size());
  const bool has_normals = samples.normals.rows() > 0;
  Points points(size, 3);
  Points normals(has_normals ? size : 0, 3);
  Index count = 0;
  for (Index i = 0; i < size; ++i) {
    const bool same = count > 0 && points.row(count - 1) == samples.points.row(rows[i]);
    if (!same) points.row(count++) = samples.points.row(rows[i]);
    if (!has_normals) continue;
    if (same) {
      normals.row(count - 1) += samples.normals.row(rows[i]);
    } else {
      normals.row(count - 1) = samples.normals.row(rows[i]);
    }
  }
  samples.repeated = size - count;
  points.conservativeResize(count, 3);
  if (has_normals) normals.conservativeResize(count, 3);
  samples.points = std::move(points);
  samples.normals = std::move(normals);
}

void require_spread(const Points& points) {
  if (points.rows() < kFewestPlaces) refuse_cloud();
  const Eigen::RowVector3d first = points.row(0);
  const Eigen::RowVector3d along = (points.row(points.rows() - 1) - first).normalized();
  double off = 0.0;
  for (Eigen::Index row = 0; row < points.rows(); ++row)
    off = std::max(off, (points.row(row) - first).cross(along).norm());
  if (!(off > 1e-9)) refuse_cloud();
}

/// Thinning has left out some already.
void drop_outliers(CloudSamples& samples) {
  const OutlierFilter filter(samples.points);
  const auto before = static_cast<Index>(samples.points.rows());
  leave_out(filter.lonely(), samples);
  samples.outliers += before - static_cast<Index>(samples.points.rows());
}

void unit_rows(Points& normals) {
  for (Eigen::Index row = 0; row < normals.rows(); ++row) {
    const double length = normals.row(row).norm();
    if (length > 0.0) normals.row(row) /= length;
  }
}

/// Areas of disks that hold so many points; the spacing of a regular arrangement of that density.
void measure_density(CloudSamples& samples, const NeighbourTable& neighbours) {
  const auto size = static_cast<Index>(samples.points.rows());
  samples.spacing = spacing_of(neighbours, size);
  samples.areas.resize(size);
  for (Index row = 0; row < size; ++row) {
    Index last = std::min<Index>(neighbours.count, size - 1) - 1;
    const double radius = neighbours.distance(row, last);
    samples.areas(row) = std::numbers::pi * radius * radius / (last + 1.5);
  }
  std::vector<double> numbers(samples.spacing.data(), samples.spacing.data() + size);
  samples.typical = quantile(numbers, 0.5);
}

}  // namespace

void require_cloud(const PointCloud& cloud) {
  require_finite(cloud.points, "points");
  if (cloud.normals.rows() == 0) return;
  if (cloud.normals.rows() != cloud.points.rows())
    throw Error(ErrorCode::BadShape,
                "a cloud has a normal for each point or none: " + std::to_string(cloud.normals.rows()) +
                    " normals of " + std::to_string(cloud.points.rows()) + " points");
  require_finite(cloud.normals, "normals");
}

CloudSamples prepare_cloud(const PointCloud& cloud, Index vertices, const Progress& progress) {
  CloudSamples samples;
  if (cloud.points.rows() < kFewestPlaces) refuse_cloud();
  samples.given = static_cast<Index>(cloud.points.rows());
  samples.points = in_own_unit(cloud.points, samples);
  samples.normals = cloud.normals;
  unit_rows(samples.normals);
  report_progress(progress, 0.05);
  const Index enough = std::max<Index>(25000, 4 * vertices);
  if (samples.points.rows() > 2 * enough) {
    thin_cloud(samples, enough, progress_within(progress, 0.05, 0.5));
  } else {
    sort_cloud(samples);
  }
  require_spread(samples.points);
  drop_outliers(samples);
  report_progress(progress, 0.7);
  const NeighbourTable neighbours = find_neighbours(PointTree(samples.points), kCloudNeighbours);
  if (samples.normals.rows() == 0) {
    samples.normals = local_planes(samples.points, neighbours).normals;
    orient_normals(samples.points, neighbours, samples.normals);
  }
  unit_rows(samples.normals);
  measure_density(samples, neighbours);
  report_progress(progress, 1.0);
  return samples;
}

}  // namespace batten
