#include "batten/fit/fit_surface.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "batten/error.h"
#include "batten/fit/enclosing_sphere.h"
#include "batten/fit/first_mesh.h"
#include "batten/fit/fit_schedule.h"
#include "batten/fit/point_tree.h"
#include "batten/fit/start_sphere.h"
#include "batten/fit/surface_fitter.h"
#include "batten/mesh/checked_values.h"
#include "batten/refine/refinement.h"
#include "batten/surface/quadrature.h"

namespace batten {

namespace {

constexpr Index kUsualVertices = 1600;

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
  if (cloud.points.rows() < 4)
    throw Error(ErrorCode::BadArgument, "a fit needs four points or more; there are " +
                                            std::to_string(cloud.points.rows()));
}

Mesh starting_mesh(const PointCloud& cloud, const FitOptions& options, const Progress& progress) {
  if (options.initial) return *options.initial;
  if (options.start == FitStart::Sphere) return start_sphere(cloud.points, options.scheme.kind);
  constexpr Index kLeast = 50;
  FirstMeshOptions first;
  first.faces = options.scheme.kind == SchemeKind::Loop ? FaceKind::Triangles : FaceKind::Quads;
  first.vertices = std::max(kLeast, options.vertices.value_or(kUsualVertices) / 4);
  first.genus = options.genus;
  return first_mesh(cloud, first, progress).mesh;
}

/// How many control points one refinement makes.
double refined_count(const Topology& topology, SchemeKind kind) {
  const double faces = kind == SchemeKind::CatmullClark ? topology.face_count() : 0.0;
  return static_cast<double>(topology.vertex_count()) + topology.edge_count() + faces;
}

/// The rounds of one fit.
class FitRun {
 public:
  FitRun(SurfaceFitter& fitter, const FitOptions& options, FitReport& report)
      : fitter_(fitter), options_(options), report_(report), schedule_(measured().first) {}

  /// All rounds and refinements.
  void go(const Progress& progress) {
    const Index most = options_.vertices.value_or(options_.initial ? 0 : kUsualVertices);
    while (true) {
      go_level(progress);
      if (report_.end == FitEnd::Tolerance) return;
      if (refined_count(fitter_.topology(), fitter_.scheme().kind) > most) return;
      fitter_.refine();
      fitter_.attach(progress);
      schedule_.note_refined();
    }
  }

 private:
  /// RMS and maximum, as shares of the diameter.
  std::pair<double, double> measured() const {
    const Scalars& distances = fitter_.distances();
    const double count = static_cast<double>(std::max<Eigen::Index>(1, distances.size()));
    return {std::sqrt(distances.squaredNorm() / count) / report_.diameter, distances.maxCoeff() / report_.diameter};
  }

  void go_level(const Progress& progress) {
    report_.end = FitEnd::Rounds;
    for (int round = 0; round < options_.rounds; ++round) {
      report_progress(progress, static_cast<double>(round) / options_.rounds);
      const auto [rms, max] = go_round();
      schedule_.note(rms, max);
      if (options_.tolerance > 0.0 && max * report_.diameter <= options_.tolerance) {
        report_.end = FitEnd::Tolerance;
        return;
      }
      if (schedule_.is_stuck()) {
        report_.end = FitEnd::Budget;
        return;
      }
    }
  }

  /// Moves by a step, or by a part of it that lowers the objective.
  std::pair<double, double> go_round() {
    constexpr int kHalvings = 4;
    const Stopwatch watch;
    FitRound round;
    const FitStep& step = schedule_.step();
    const Values before = fitter_.control();
    SolveReport solved;
    Values move = fitter_.find_step(step, &solved);
    round.objective = fitter_.objective(step.fairness);
    for (int halving = 0; halving <= kHalvings; ++halving) {
      if (halving == kHalvings) move.setZero();
      fitter_.move_to(fitter_.stepped(before, move));
      fitter_.attach();
      round.after = fitter_.objective(step.fairness);
      if (round.after <= round.objective) break;
      move *= 0.5;
    }
    const auto [rms, max] = measured();
    round.vertices = fitter_.topology().vertex_count();
    round.fairness = step.fairness;
    round.max = max * report_.diameter;
    round.rms = rms * report_.diameter;
    round.iterations = solved.iterations;
    round.seconds = watch.seconds();
    report_.rounds.push_back(round);
    return {rms, max};
  }

  SurfaceFitter& fitter_;
  const FitOptions& options_;
  FitReport& report_;
  FitSchedule schedule_;
};

/// From places spread over the surface to the nearest points.
DistanceSummary measure_to_points(const SurfaceFitter& fitter) {
  constexpr int kPlaces = 4;
  const LimitSurface surface(fitter.topology(), fitter.scheme(), fitter.control());
  const SurfaceQuadrature quadrature = surface_quadrature(surface.patches(), {kPlaces, 0});
  std::vector<Jet> jets(quadrature.places.size());
  surface.jets(quadrature.places, jets);
  const PointTree tree(fitter.cloud().points);
  Scalars distances(static_cast<Eigen::Index>(jets.size()));
  for (std::size_t i = 0; i < jets.size(); ++i)
    distances[static_cast<Eigen::Index>(i)] = tree.distance(jets[i].point.transpose());
  return summarize_distances(distances);
}

}  // namespace

FitResult fit_surface(const PointCloud& cloud, const FitOptions& options, const Progress& progress) {
  const Stopwatch watch;
  require_options(cloud, options);
  FitReport report;
  report.diameter = 2.0 * enclosing_sphere(cloud.points).radius;
  if (!(report.diameter > 0.0)) throw Error(ErrorCode::BadArgument, "all points are at the same place");
  const Progress preparing = progress_within(progress, 0.0, 0.2);
  PointCloud known = cloud;
  if (known.normals.rows() == 0) known.normals = estimate_normals(cloud.points, {}, preparing);
  const Mesh start = starting_mesh(known, options, preparing);
  SurfaceFitter fitter(Topology(start), options.scheme, start.points, known, preparing);
  fitter.attach(preparing);
  FitRun run(fitter, options, report);
  const Progress rounds = progress_within(progress, 0.2, 1.0);
  try {
    run.go(rounds);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Cancelled || report.rounds.empty()) throw;
    report.end = FitEnd::Cancelled;
    fitter.attach();
  }
  report.spacing = fitter.spacing();
  report.to_surface = summarize_distances(fitter.distances());
  report.to_points = measure_to_points(fitter);
  report.seconds = watch.seconds();
  Mesh mesh = mesh_from_topology(fitter.topology());
  mesh.points = fitter.control();
  state_scheme(fitter.scheme(), mesh);
  return {std::move(mesh), fitter.topology(), fitter.scheme(), fitter.distances(), std::move(report)};
}

}  // namespace batten
