#include "batten/interpolate/fair_interpolation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "batten/energy/shape_energy.h"
#include "batten/error.h"
#include "batten/interpolate/fair_system.h"
#include "batten/interpolate/interpolator.h"
#include "batten/interpolate/measured_error.h"
#include "batten/mesh/checked_values.h"
#include "batten/mesh/measures.h"
#include "batten/progress.h"
#include "batten/refine/child_topology.h"
#include "batten/refine/refinement.h"

namespace batten {

namespace {

constexpr int kMostRounds = 20;
/// In diagonals, about: control points of a sound surface stay nearer. Others are of a system that was nearly singular,
/// and their surface may have lost its tangent planes and with them its energy.
constexpr double kFarthest = 20.0;
/// Of the rounds before the last, which only give lengths.
constexpr double kReferenceTolerance = 1e-4;

void require_options(const FairOptions& options, Index vertices) {
  const auto refuse = [](const std::string& what) { throw Error(ErrorCode::BadArgument, what); };
  const int levels = options.levels.value_or(1);
  if (levels < 1 || levels > 2) refuse("a fair surface is refined 1 or 2 times, not " + std::to_string(levels));
  if (options.rounds < 1 || options.rounds > kMostRounds) {
    refuse("there are 1 to " + std::to_string(kMostRounds) + " rounds, not " + std::to_string(options.rounds));
  }
  if (!(options.smoothing >= 0.0) || !std::isfinite(options.smoothing)) {
    refuse("the smoothing is a length, finite and not negative; give 0 to pass through the points");
  }
  if (!(options.tolerance > 0.0)) refuse("the tolerance is positive");
  if (options.normals.size() == 0) return;
  if (options.levels == 1) refuse("normals need two refinements: with one, those of neighbours depend on each other");
  if (options.normals.rows() != vertices || options.normals.cols() != 3) {
    throw Error(ErrorCode::BadShape,
                "normals must have three columns and a row for each of the " + std::to_string(vertices) + " vertices");
  }
  require_finite(options.normals, "normals");
}

/// Coordinates in which the targets are centred and their bounding box has a diagonal in [1, 2), so that squares and
/// differences keep their digits.
struct UnitFrame {
  Eigen::RowVector3d centre;
  double diagonal;
  double scale;

  explicit UnitFrame(ConstValuesRef targets) {
    const BoundingBox box = bounding_box(targets);
    centre = 0.5 * box.low + 0.5 * box.high;
    diagonal = (box.high - box.low).stableNorm();
    scale = diagonal > 0.0 && std::isfinite(diagonal) ? std::ldexp(1.0, -std::ilogb(diagonal)) : 1.0;
  }
  Values inwards(ConstValuesRef points) const { return scale * (points.rowwise() - centre); }
  Values outwards(const Values& points) const { return (points / scale).rowwise() + centre; }
};

int order_of(ShapeEnergyKind kind) { return static_cast<int>(kind) + 1; }

/// A plane wave of height h and number k = 2 pi/length has the energy k^(2 order) h^2/2 an area. Weighed like this,
/// its distance from targets of height 1, (1 - h)^2/2 an area, balances it at h = 1/2.
Scalars smoothing_weights(const Topology& topology, ConstValuesRef targets, ShapeEnergyKind kind, double length) {
  const double density = std::pow(2.0 * std::numbers::pi / length, 2 * order_of(kind));
  Scalars weights = Scalars::Zero(topology.vertex_count());
  for (Index f = 0; f < topology.face_count(); ++f) {
    double area = 0.0;
    const Index first = topology.face_begin(f);
    const auto point = [&](Index h) -> Eigen::RowVector3d { return targets.row(topology.origin(h)); };
    for (Index h = first + 1; h + 1 < topology.face_end(f); ++h) {
      area += 0.5 * (point(h) - point(first)).cross(point(h + 1) - point(first)).norm();
    }
    for (Index h = first; h < topology.face_end(f); ++h) {
      weights[topology.origin(h)] += density * area / topology.face_size(f);
    }
  }
  return weights;
}

/// The mesh that the surface's control points belong to.
struct FineMesh {
  Topology topology;
  Scheme scheme;
  int levels;
};

/// Control points of the surface that Interpolator gives, on the fine mesh; none where it does not meet the targets.
std::optional<Values> plain_control(const Topology& topology, const Scheme& scheme, ConstValuesRef targets, int levels,
                                    const Progress& progress) {
  InterpolateOptions options;
  options.refined = RefinedExtent::Everything;
  try {
    Interpolant plain = Interpolator(topology, scheme, options, progress_within(progress, 0.0, 0.4))
                            .solve(targets, progress_within(progress, 0.4, 0.9));
    if (!plain.report.converged()) return std::nullopt;
    const int left = plain.topology.vertex_count() > topology.vertex_count() ? levels - 1 : levels;
    return refine(plain.topology, plain.scheme, plain.control, left, progress_within(progress, 0.9, 1.0)).values;
  } catch (const Error& error) {
    if (error.code() == ErrorCode::Cancelled) throw;
    return std::nullopt;
  }
}

/// Rounds of references, in the unit frame.
class FairSolve {
 public:
  FairSolve(const FineMesh& fine, Index original_count, const FairOptions& options, Scalars position_weights,
            const Progress& progress)
      : fine_(fine),
        options_(options),
        position_weights_(std::move(position_weights)),
        energy_(SurfacePatches(fine.topology, fine.scheme), options.energy, kShapeQuadrature,
                progress_within(progress, 0.0, 0.8)),
        limit_(fine.topology, fine.scheme),
        system_(limit_, original_count, position_weights_) {
    report_progress(progress, 1.0);
  }

  const LimitMatrix& limit() const { return limit_; }
  double energy(const Values& control) const { return energy_.energy(control); }
  const FairNormals& normals() const { return normals_; }

  /// The control points after all rounds. lengths: the first reference. plain: where the search starts, with its
  /// normals turned, if there is one.
  Values run(const Values& targets, const Values& lengths, const std::optional<Values>& plain, FairReport& report,
             const Progress& progress);

 private:
  double objective(const Values& control, const Values& targets) const;
  bool improve(const Values& least, const Values& targets, Values& control, double& level) const;

  FineMesh fine_;
  const FairOptions& options_;
  Scalars position_weights_;
  ShapeEnergy energy_;
  LimitMatrix limit_;
  FairSystem system_;
  FairNormals normals_;
};

/// What is to be least, by the surface's own lengths.
double FairSolve::objective(const Values& control, const Values& targets) const {
  double sum = energy_.energy(control);
  if (position_weights_.size() == 0) return sum;
  const Buffer<double> errors = row_errors(limit_, control, targets);
  for (std::size_t v = 0; v < errors.size(); ++v) sum += position_weights_[v] * errors[v] * errors[v];
  return sum;
}

/// The least of the quadratic energy need not have less energy in its own lengths. On the way to it from control points
/// that meet the same conditions there may be some that have: all of the way, or a half, a quarter, an eighth.
bool FairSolve::improve(const Values& least, const Values& targets, Values& control, double& level) const {
  for (const double step : {1.0, 0.5, 0.25, 0.125}) {
    Values trial = control + step * (least - control);
    if (!(trial.cwiseAbs().maxCoeff() < kFarthest)) continue;
    const double reached = objective(trial, targets);
    if (!(reached < level)) continue;
    control = std::move(trial);
    level = reached;
    return true;
  }
  return false;
}

Values FairSolve::run(const Values& targets, const Values& lengths, const std::optional<Values>& plain,
                      FairReport& report, const Progress& progress) {
  if (options_.normals.size() > 0) {
    const Values nothing = Values::Zero(system_.to_control().cols(), 3);
    normals_ = FairNormals(limit_, options_.normals, system_.to_control(), system_.control(nothing, targets));
  }
  std::optional<Values> control;
  if (plain) {
    Values unknowns = system_.unknowns(*plain);
    normals_.meet(unknowns);
    control = system_.control(unknowns, targets);
  }
  double level = control ? objective(*control, targets) : 0.0;
  report.kept_plain = control.has_value();
  StopRule stop;
  stop.max_iterations = options_.max_iterations;
  for (int round = 0; round < options_.rounds; ++round) {
    const Progress of_round =
        progress_within(progress, static_cast<double>(round) / options_.rounds, (round + 1.0) / options_.rounds);
    const Values& reference = round == 0 || !control ? lengths : *control;
    const ShapeEnergy::Matrix matrix = energy_.matrix(reference, progress_within(of_round, 0.0, 0.3));
    const bool is_last = round + 1 == options_.rounds;
    stop.tolerance = is_last ? options_.tolerance : std::max(options_.tolerance, kReferenceTolerance);
    stop.progress = progress_within(of_round, 0.4, 0.95);
    Values unknowns = system_.unknowns(control ? *control : lengths);
    report.solve.append(system_.minimise(matrix, targets, normals_, stop, unknowns), ", ");
    Values least = system_.control(unknowns, targets);
    if (!control) {
      level = objective(least, targets);
      control = std::move(least);
    } else if (improve(least, targets, *control, level)) {
      report.kept_plain = false;
    } else if (round > 0) {
      break;
    }
  }
  report.energy = position_weights_.size() == 0 ? level : energy_.energy(*control);
  return system_.control(system_.unknowns(*control), targets);
}

/// Angles between the normals wanted and those of the surface.
void measure_normals(const FineMesh& fine, const FairNormals& normals, ConstValuesRef wanted, const Values& control,
                     FairReport& report) {
  if (normals.empty()) return;
  const LimitNormals reached = limit_normals(fine.topology, fine.scheme, control);
  report.normal_count = normals.count();
  for (const Index v : normals.vertices()) {
    const Eigen::RowVector3d n = reached.vertices.row(v);
    const Eigen::RowVector3d w = wanted.row(v).normalized();
    report.max_angle = std::max(report.max_angle, std::atan2(n.cross(w).norm(), n.dot(w)));
  }
}

void measure_positions(const LimitMatrix& limit, const Values& control, ConstValuesRef targets, FairReport& report) {
  const Buffer<double> errors = row_errors(limit, control, targets);
  double squares = 0.0;
  for (std::size_t v = 0; v < errors.size(); ++v) {
    squares += errors[v] * errors[v];
    if (report.worst_vertex >= 0 && !(errors[v] > report.max_error)) continue;
    report.max_error = errors[v];
    report.worst_vertex = static_cast<Index>(v);
  }
  report.rms_error = errors.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(errors.size()));
}

}  // namespace

FairInterpolant interpolate_fairly(const Topology& topology, const Scheme& scheme, ConstValuesRef targets,
                                   const FairOptions& options, const Progress& progress) {
  require_control_points(topology, targets);
  require_triangles(topology, scheme);
  require_options(options, topology.vertex_count());
  if (is_interpolating(scheme.kind)) {
    throw Error(ErrorCode::BadArgument, std::string(scheme_name(scheme.kind)) +
                                            " has one surface through the points; use Catmull-Clark or Loop");
  }
  if (scheme.boundary == BoundaryRule::None) {
    throw Error(ErrorCode::BadArgument,
                "where boundaries are no part of the surface (boundary none) the points there have no energy and no "
                "fairest place; use boundary edge-only or edge-and-corner");
  }
  const int levels = options.levels.value_or(options.normals.size() > 0 ? 2 : 1);
  const UnitFrame frame(targets);
  const Values wanted = frame.inwards(targets);
  const std::optional<Values> plain =
      plain_control(topology, scheme, wanted, levels, progress_within(progress, 0.0, 0.1));
  RefinedSurface start = refine(with_surface_holes(topology, scheme), scheme, wanted, levels);
  const FineMesh fine{start.topology, scheme.after_first_step(), levels};
  Scalars weights;
  if (options.smoothing > 0.0) {
    weights = smoothing_weights(topology, wanted, options.energy, options.smoothing * frame.scale);
  }
  FairSolve solve(fine, topology.vertex_count(), options, std::move(weights), progress_within(progress, 0.1, 0.2));
  FairReport report;
  report.levels = levels;
  Values control = solve.run(wanted, start.values, plain, report, progress_within(progress, 0.2, 0.95));
  report.plain_energy = plain ? solve.energy(*plain) : std::numeric_limits<double>::quiet_NaN();
  report.diagonal = frame.diagonal;
  const double unit = std::pow(frame.scale, 2 * order_of(options.energy) - 4);
  report.plain_energy *= unit;
  report.energy *= unit;
  measure_normals(fine, solve.normals(), options.normals, control, report);
  control = frame.outwards(control);
  measure_positions(solve.limit(), control, targets, report);
  report_progress(progress, 1.0);
  return {fine.topology, fine.scheme, std::move(control), std::move(report)};
}

}  // namespace batten
