#include "batten/medial/medial_surface.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <utility>

#include "batten/limit/limit_matrix.h"
#include "batten/progress.h"

namespace batten {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

SpokeMeasure measure_of(const Scalars& numbers) {
  SpokeMeasure measure;
  double squares = 0.0;
  double sum = 0.0;
  Index count = 0;
  for (Index vertex = 0; vertex < static_cast<Index>(numbers.size()); ++vertex) {
    const double number = numbers(vertex);
    if (std::isnan(number)) continue;
    sum += number;
    squares += number * number;
    ++count;
    if (measure.worst_vertex >= 0 && number <= measure.max) continue;
    measure.max = number;
    measure.worst_vertex = vertex;
  }
  if (count == 0) return measure;
  measure.mean = sum / count;
  measure.rms = std::sqrt(squares / count);
  return measure;
}

/// NaN where the surface has no normal.
double angle_to(const Eigen::RowVector3d& direction, const Eigen::RowVector3d& normal) {
  if (!(normal.squaredNorm() > 0.0)) return kNone;
  return std::atan2(direction.cross(normal).norm(), direction.dot(normal));
}

/// |p - p'| / r for one atom (MedialErrors::shifts).
double shift_of(const MedialBoundary& boundary, const SpokePair& pair, const Values& reached, const Values& normals) {
  const Eigen::RowVector3d up_normal = normals.row(pair.up);
  const Eigen::RowVector3d down_normal = normals.row(pair.down);
  if (!(up_normal.squaredNorm() > 0.0 && down_normal.squaredNorm() > 0.0)) return kNone;
  const Eigen::RowVector3d up = boundary.radii(pair.up) * up_normal;
  const Eigen::RowVector3d down = boundary.radii(pair.down) * down_normal;
  const Eigen::RowVector3d across = reached.row(pair.up) - reached.row(pair.down);
  const double square = (up - down).squaredNorm();
  const double scale = square > 0.0 ? across.dot(up - down) / square : 1.0;
  const Eigen::RowVector3d fitted = 0.5 * (reached.row(pair.up) + reached.row(pair.down)) - 0.5 * scale * (up + down);
  const double radius = 0.5 * (boundary.radii(pair.up) + boundary.radii(pair.down));
  return (fitted - boundary.origins.row(pair.up)).norm() / radius;
}

}  // namespace

MedialErrors measure_medial_errors(const MedialBoundary& boundary, const Topology& topology, const Scheme& scheme,
                                   ConstValuesRef control) {
  const Index count = boundary.mesh.vertex_count();
  const Values reached = LimitMatrix(topology, scheme).apply(control);
  const Values normals = limit_normals(topology, scheme, control).vertices;
  MedialErrors errors;
  errors.distances.resize(count);
  errors.angles.resize(count);
  errors.shifts = Scalars::Constant(count, kNone);
  for (Index vertex = 0; vertex < count; ++vertex) {
    errors.distances(vertex) = (reached.row(vertex) - boundary.mesh.points.row(vertex)).norm();
    errors.angles(vertex) = angle_to(boundary.directions.row(vertex), normals.row(vertex));
  }
  for (const SpokePair& pair : spoke_pairs(boundary)) {
    const double shift = shift_of(boundary, pair, reached, normals);
    errors.shifts(pair.up) = shift;
    errors.shifts(pair.down) = shift;
  }
  errors.distance = measure_of(errors.distances);
  errors.distance_share = measure_of(errors.distances.cwiseQuotient(boundary.radii));
  errors.angle = measure_of(errors.angles);
  errors.shift = measure_of(errors.shifts);
  return errors;
}

MedialSurface medial_surface(const MedialModel& model, const InterpolateOptions& options, const Progress& progress) {
  constexpr double kSolved = 0.9;  // of the time
  MedialBoundary boundary = medial_boundary(model);
  InterpolatedMesh surface = interpolate(boundary.mesh, options, progress_within(progress, 0.0, kSolved));
  MedialErrors errors = measure_medial_errors(boundary, surface.topology, surface.scheme, surface.mesh.points);
  report_progress(progress, 1.0);
  return {std::move(boundary), std::move(surface), std::move(errors)};
}

}  // namespace batten
