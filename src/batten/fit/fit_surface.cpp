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
#include "batten/fit/own_frame.h"
#include "batten/fit/surface_fitter.h"
#include "batten/fit/thin_cloud.h"
#include "batten/mesh/checked_values.h"
#include "batten/mesh/measures.h"
#include "batten/nearest/distance_summary.h"
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

/// The points that the rounds work with: one at each place, in an order that depends on their places alone, so that the
/// order in which they are given changes no bit.
struct WorkingCloud {
  OwnFrame frame;
  Points placed;         ///< all points in the frame; none where it is the frame of the points
  Buffer<Index> places;  ///< of each point of the whole cloud, here; -1 for those that are left out
  PointCloud cloud;
};

/// Of the points of different places.
Points sorted_places(const Points& points) {
  const Buffer<Index> sorted = sorted_rows(points);
  std::vector<Index> rows;
  for (const Index row : sorted) {
    if (rows.empty() || points.row(row) != points.row(rows.back())) rows.push_back(row);
  }
  return points(rows, Eigen::all);
}

/// A fit that finds its first mesh works in a frame that the points give, with coordinates that are cut off where a
/// motion of the points would round them.
bool has_own_frame(const FitOptions& options) { return !options.initial && options.start == FitStart::Auto; }

WorkingCloud working_cloud(const PointCloud& cloud, const FitOptions& options) {
  // Moves of a Loop mesh ask for all that is known of thin parts.
  const Index least = options.scheme.kind == SchemeKind::Loop ? 20000 : 10000;
  constexpr Index kOfVertex = 12;
  const Index start = options.initial ? options.initial->vertex_count() : 0;
  const Index vertices = std::max(start, options.vertices.value_or(kUsualFitVertices));
  const Index most = std::max(least, kOfVertex * std::min(vertices, std::numeric_limits<Index>::max() / kOfVertex));
  WorkingCloud working;
  const bool own = has_own_frame(options);
  if (own) {
    working.frame = own_frame(cloud.points.rows() > most ? cloud.points : sorted_places(cloud.points));
    working.placed = working.frame.into(cloud.points);
  }
  const Points& all = own ? working.placed : cloud.points;
  const Buffer<Index> thin = thinned_rows(all, most);
  Points points = all(thin, Eigen::all);
  Points normals = cloud.normals.rows() > 0 ? Points(cloud.normals(thin, Eigen::all)) : Points(0, 3);
  if (own) {
    drop_rounding(points);
    normals = working.frame.turned(normals);
    drop_rounding(normals);
  }
  working.places.assign(static_cast<std::size_t>(cloud.points.rows()), -1);
  Buffer<Index> rows;
  for (const Index row : sorted_rows(points, normals)) {
    if (rows.empty() || points.row(row) != points.row(rows.back())) rows.push_back(row);
    working.places[thin[row]] = static_cast<Index>(rows.size()) - 1;
  }
  working.cloud.points = points(rows, Eigen::all);
  if (normals.rows() > 0) working.cloud.normals = normals(rows, Eigen::all);
  return working;
}

/// The options as they are in a frame.
FitOptions in_frame(const FitOptions& options, const OwnFrame& frame) {
  FitOptions placed = options;
  placed.tolerance /= frame.size;
  if (placed.bridge) *placed.bridge /= frame.size;
  if (options.watch) {
    placed.watch = [watch = options.watch, frame](const SurfaceFrame& shown) {
      watch({shown.topology, shown.scheme, frame.back(shown.control)});
    };
  }
  return placed;
}

void scale_rounds(double size, FitReport& report) {
  for (FitRound& round : report.rounds) {
    round.max *= size;
    round.rms *= size;
    round.objective *= size * size;
    round.after *= size * size;
  }
}

DistanceSummary scaled(double size, DistanceSummary summary) {
  for (double* const length : {&summary.max, &summary.rms, &summary.mean, &summary.median, &summary.most_of_95,
                               &summary.most_of_99, &summary.most_outside, &summary.most_inside})
    *length *= size;
  return summary;
}

/// What a fit in a frame has reached, in the unit of the points.
FitResult result_of(const PointCloud& cloud, const WorkingCloud& working, const OutlierFilter& filter,
                    FitAttempt made) {
  const SurfaceFitter& fitter = made.fitter;
  const double size = working.frame.size;
  const bool own = working.placed.rows() > 0;
  const Points& all = own ? working.placed : cloud.points;
  FitReport report = std::move(made.report);
  const bool thinned = std::count(working.places.begin(), working.places.end(), -1) > 0;
  Scalars distances(cloud.points.rows());
  Buffer<std::uint8_t> outliers(static_cast<std::size_t>(cloud.points.rows()));
  report.spacing = filter.spacing();
  if (own || thinned) distances = measure_to_surface(fitter, all);
  if (thinned) {
    report.spacing = sampled_spacing(all, filter.spacing());
    outliers = filter.far_of(all, distances, fitter.distances(), report.spacing);
  }
  for (std::size_t row = 0; row < working.places.size(); ++row) {
    if (working.places[row] < 0) continue;
    if (!own) distances[static_cast<Eigen::Index>(row)] = fitter.distances()[working.places[row]];
    outliers[row] = made.outliers[working.places[row]];
  }
  distances *= size;
  report.spacing *= size;
  report.to_surface = summarize_followed(distances, outliers, report.outliers);
  report.to_points = scaled(size, measure_to_points(fitter));
  report.unsound = fitter.unsound_faces();
  scale_rounds(size, report);
  const Points control = own ? working.frame.back(fitter.control()) : Points(fitter.control());
  Mesh mesh = frame_mesh({fitter.topology(), fitter.scheme(), control});
  return {std::move(mesh), fitter.topology(), fitter.scheme(), std::move(distances), std::move(report)};
}

}  // namespace

FitResult fit_surface(const PointCloud& cloud, const FitOptions& options, const Progress& progress) {
  const Stopwatch watch;
  require_options(cloud, options);
  const double diameter = 2.0 * enclosing_sphere(cloud.points).radius;
  if (bounding_diagonal(cloud.points) == 0.0) throw Error(ErrorCode::BadArgument, "all points are at the same place");
  if (!(diameter > 0.0) || !std::isfinite(diameter))
    throw Error(ErrorCode::BadArgument,
                "squares of distances between the points are too large or too small for doubles; scale the points");
  const WorkingCloud working = working_cloud(cloud, options);
  const bool own = has_own_frame(options);
  const FitOptions placed = own ? in_frame(options, working.frame) : options;
  const OutlierFilter filter(working.cloud.points, progress_within(progress, 0.0, 0.02));
  const double working_diameter = own ? 2.0 * enclosing_sphere(working.cloud.points).radius : diameter;
  FitResult result =
      result_of(cloud, working, filter,
                make_fit(working.cloud, placed, filter, working_diameter, progress_within(progress, 0.02, 1.0)));
  result.report.diameter = diameter;
  result.report.seconds = watch.seconds();
  return result;
}

}  // namespace batten
