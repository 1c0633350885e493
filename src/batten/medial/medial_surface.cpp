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
    errors.angles(vertex) = angle_between(boundary.directions.row(vertex), normals.row(vertex));
  }
  for (const SpokePair& pair : spoke_pairs(boundary)) {
    const double shift = shift_of(boundary, pair, reached, normals);
    errors.shifts(pair.up) = shift;
    errors.shifts(pair.down) = shift;
  }
  errors.distance = measure_numbers(errors.distances);
  errors.distance_share = measure_numbers(errors.distances.cwiseQuotient(boundary.radii));
  errors.angle = measure_numbers(errors.angles);
  errors.shift = measure_numbers(errors.shifts);
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

TurnReport turn_to_spokes(MedialSurface& made, const TurnOptions& options, const Progress& progress) {
  constexpr double kTurned = 0.9;  // of the time
  InterpolatedMesh& surface = made.surface;
  TurnReport report = turn_normals(surface, made.boundary.directions, options, progress_within(progress, 0.0, kTurned));
  made.errors = measure_medial_errors(made.boundary, surface.topology, surface.scheme, surface.mesh.points);
  report_progress(progress, 1.0);
  return report;
}

}  // namespace batten
