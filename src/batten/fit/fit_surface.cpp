#include "batten/fit/fit_surface.h"

#include <algorithm>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "batten/error.h"
#include "batten/fit/cloud_samples.h"
#include "batten/fit/enclosing_sphere.h"
#include "batten/fit/fit_attempt.h"
#include "batten/fit/fit_distances.h"
#include "batten/fit/fit_levels.h"
#include "batten/fit/outliers.h"
#include "batten/fit/surface_fitter.h"
#include "batten/fit/thin_cloud.h"
#include "batten/mesh/checked_values.h"
#include "batten/mesh/measures.h"
#include "batten/solve/solver.h"

namespace batten {

namespace {

/// From a mesh that lies apart from the points by more than either is large, all points are nearest to the same few
/// places, and the surface would be torn to them.
void require_start_near(const Points& start, const Points& points) {
  const BoundingBox there = bounding_box(start);
  const BoundingBox here = bounding_box(points);
  const Eigen::RowVector3d gaps = (there.low - here.high).cwiseMax(here.low - there.high).cwiseMax(0.0);
  const double gap = gaps.stableNorm();
  if (!(gap > std::max((there.high - there.low).stableNorm(), (here.high - here.low).stableNorm()))) return;
  std::ostringstream text;
  text << "the control mesh to start from lies " << gap
       << " away from the points, farther than either is large: move it to them";
  throw Error(ErrorCode::BadArgument, text.str());
}

void require_options(const PointCloud& cloud, const FitOptions& options) {
  require_finite(cloud.points, "points");
  if (cloud.normals.rows() != 0 && cloud.normals.rows() != cloud.points.rows())
    throw Error(ErrorCode::BadShape, "there are " + std::to_string(cloud.normals.rows()) + " normals for " +
                                         std::to_string(cloud.points.rows()) + " points");
  require_finite(cloud.normals, "normals");
  if (is_interpolating(options.scheme.kind))
    throw Error(ErrorCode::BadArgument, std::string("a fit has Catmull-Clark or Loop surfaces, none of the ") +
                                            scheme_name(options.scheme.kind) + " scheme");
  if (!(options.tolerance >= 0.0)) throw Error(ErrorCode::BadArgument, "the tolerance must be 0 or more");
  if (options.rounds < 1) throw Error(ErrorCode::BadArgument, "a fit takes one round or more");
  if (options.initial && !(bounding_diagonal(options.initial->points) > 0.0))
    throw Error(ErrorCode::BadArgument, "all vertices of the control mesh to start from are at the same place");
  if (cloud.points.rows() < 4)
    throw Error(ErrorCode::BadArgument,
                "a fit needs four points or more; there are " + std::to_string(cloud.points.rows()));
  if (options.initial) require_start_near(options.initial->points, cloud.points);
}

/// The points that the rounds work with: in the order of their coordinates, so that the order in which they are given
/// changes no bit, and one at each place.
struct WorkingCloud {
  Buffer<Index> places;  ///< of each point of the whole cloud, here; -1 for those that are left out
  PointCloud cloud;
};

WorkingCloud working_cloud(const PointCloud& cloud, const FitOptions& options) {
  // Moves of a Loop mesh ask for all that is known of thin parts.
  const Index least = options.scheme.kind == SchemeKind::Loop ? 20000 : 10000;
  constexpr Index kOfVertex = 12;
  const Index start = options.initial ? options.initial->vertex_count() : 0;
  const Index vertices = std::max(start, options.vertices.value_or(kUsualFitVertices));
  const Index most = std::max(least, kOfVertex * std::min(vertices, std::numeric_limits<Index>::max() / kOfVertex));
  const Buffer<Index> thin = thinned_rows(cloud.points, most);
  WorkingCloud working;
  const Points normals = cloud.normals.rows() > 0 ? Points(cloud.normals(thin, Eigen::all)) : Points(0, 3);
  working.places.assign(static_cast<std::size_t>(cloud.points.rows()), -1);
  Buffer<Index> rows;
  for (const Index place : sorted_rows(cloud.points(thin, Eigen::all), normals)) {
    const Index row = thin[place];
    if (rows.empty() || cloud.points.row(row) != cloud.points.row(rows.back())) rows.push_back(row);
    working.places[row] = static_cast<Index>(rows.size()) - 1;
  }
  working.cloud.points = cloud.points(rows, Eigen::all);
  if (cloud.normals.rows() > 0) working.cloud.normals = cloud.normals(rows, Eigen::all);
  return working;
}

}  // namespace

FitResult fit_surface(const PointCloud& cloud, const FitOptions& options, const Progress& progress) {
  const Stopwatch watch;
  require_options(cloud, options);
  FitReport report;
  report.diameter = 2.0 * enclosing_sphere(cloud.points).radius;
  if (bounding_diagonal(cloud.points) == 0.0) throw Error(ErrorCode::BadArgument, "all points are at the same place");
  if (!(report.diameter > 0.0) || !std::isfinite(report.diameter))
    throw Error(ErrorCode::BadArgument,
                "squares of distances between the points are too large or too small for doubles; scale the points");
  const WorkingCloud working = working_cloud(cloud, options);
  const PointCloud& known = working.cloud;
  const OutlierFilter filter(known.points, progress_within(progress, 0.0, 0.02));
  FitAttempt made = make_fit(known, options, filter, report.diameter, progress_within(progress, 0.02, 1.0));
  SurfaceFitter& fitter = made.fitter;
  const Buffer<std::uint8_t>& left_out = made.outliers;
  report = std::move(made.report);
  Scalars distances(cloud.points.rows());
  Buffer<std::uint8_t> outliers(static_cast<std::size_t>(cloud.points.rows()));
  report.spacing = filter.spacing();
  if (std::count(working.places.begin(), working.places.end(), -1) > 0) {
    distances = measure_to_surface(fitter, cloud.points);
    report.spacing = sampled_spacing(cloud.points, filter.spacing());
    outliers = filter.far_of(cloud.points, distances, fitter.distances(), report.spacing);
  }
  for (std::size_t row = 0; row < working.places.size(); ++row) {
    if (working.places[row] < 0) continue;
    distances[static_cast<Eigen::Index>(row)] = fitter.distances()[working.places[row]];
    outliers[row] = left_out[working.places[row]];
  }
  report.to_surface = summarize_followed(distances, outliers, report.outliers);
  report.to_points = measure_to_points(fitter);
  report.unsound = fitter.unsound_faces();
  report.seconds = watch.seconds();
  Mesh mesh = frame_mesh({fitter.topology(), fitter.scheme(), fitter.control()});
  return {std::move(mesh), fitter.topology(), fitter.scheme(), std::move(distances), std::move(report)};
}

}  // namespace batten
