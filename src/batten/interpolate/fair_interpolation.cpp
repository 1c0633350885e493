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
#include "batten/limit/vertex_limit.h"
#include "batten/mesh/checked_values.h"
#include "batten/mesh/measures.h"
#include "batten/parallel/parallel.h"
#include "batten/progress.h"
#include "batten/refine/child_topology.h"
#include "batten/refine/refinement.h"

namespace batten {

namespace {

constexpr int kMostRounds = 20;
constexpr std::ptrdiff_t kBlock = 512;  // vertices that a thread takes at a time
/// In diagonals, about: control points of a sound surface stay nearer. Others are of a system that was nearly singular,
/// and their surface may have lost its tangent planes and with them its energy.
constexpr double kFarthest = 20.0;
/// Where energies by a reference's lengths are within this share of those by a surface's own, the next round would gain
/// a thousandth (docs/decisions/011-fair-solver.md).
constexpr double kSameLengths = 0.01;

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
  FairSolve(const FineMesh& fine, const Values& targets, const FairOptions& options, Scalars position_weights,
            const Progress& progress)
      : targets_(targets),
        options_(options),
        position_weights_(std::move(position_weights)),
        energy_(SurfacePatches(fine.topology, fine.scheme), options.energy, kShapeQuadrature,
                progress_within(progress, 0.0, 0.8)),
        limit_(fine.topology, fine.scheme),
        system_(limit_, static_cast<Index>(targets.rows()), position_weights_) {
    if (options.normals.size() > 0) {
      const Values nothing = Values::Zero(system_.to_control().cols(), 3);
      normals_ = FairNormals(limit_, options.normals, system_.to_control(), system_.control(nothing, targets));
    }
    report_progress(progress, 1.0);
  }

  const LimitMatrix& limit() const { return limit_; }
  double energy(const Values& control) const { return energy_.energy(control); }
  const FairNormals& normals() const { return normals_; }

  /// The control points after all rounds. lengths: the first reference. plain: where the search starts, with its
  /// normals turned, if there is one.
  Values run(const Values& lengths, const std::optional<Values>& plain, FairReport& report, const Progress& progress);

 private:
  /// The control points of the fairest surface so far, if there is one, and its objective().
  struct Best {
    std::optional<Values> control = {};
    double level = 0.0;
  };
  /// What a round comes to.
  struct Round {
    bool improved;
    bool settled;  ///< another one, in the lengths of the best, would hardly change it
  };
  double objective(const Values& control) const;
  bool improve(const Values& least, Best& best) const;
  Round search(const Values& reference, Best& best, FairReport& report, const Progress& progress);
  void turn_opposed(const Values& model, Best& best, FairReport& report, const Progress& progress);

  const Values& targets_;
  const FairOptions& options_;
  Scalars position_weights_;
  ShapeEnergy energy_;
  LimitMatrix limit_;
  FairSystem system_;
  FairNormals normals_;
};

/// What is to be least, by the surface's own lengths.
double FairSolve::objective(const Values& control) const {
  double sum = energy_.energy(control);
  if (position_weights_.size() == 0) return sum;
  const Buffer<double> errors = row_errors(limit_, control, targets_);
  for (std::size_t v = 0; v < errors.size(); ++v) sum += position_weights_[v] * errors[v] * errors[v];
  return sum;
}

/// The least of the quadratic energy need not have less energy in its own lengths. On the way to it from control points
/// that meet the same conditions there may be some that have: all of the way, or a half, a quarter, an eighth.
bool FairSolve::improve(const Values& least, Best& best) const {
  for (const double step : {1.0, 0.5, 0.25, 0.125}) {
    Values trial = *best.control + step * (least - *best.control);
    if (!(trial.cwiseAbs().maxCoeff() < kFarthest)) continue;
    const double reached = objective(trial);
    if (!(reached < best.level)) continue;
    best = {std::move(trial), reached};
    return true;
  }
  return false;
}

/// A round: the least of the quadratic energy in the lengths of `reference`. It settles the surface where these suit
/// both what the round started from and what it found.
FairSolve::Round FairSolve::search(const Values& reference, Best& best, FairReport& report, const Progress& progress) {
  const StopRule stop{options_.tolerance, options_.max_iterations, progress_within(progress, 0.4, 0.95)};
  Values unknowns = system_.unknowns(best.control ? *best.control : reference);
  FairSystem::Least found = system_.minimise(energy_.matrix(reference, progress_within(progress, 0.0, 0.3)), targets_,
                                             normals_, stop, unknowns);
  report.solve.append(found.solve, ", ");
  Values least = system_.control(unknowns, targets_);
  if (!best.control) {
    best = {std::move(least), 0.0};
    best.level = objective(*best.control);
    return {true, false};
  }
  const auto suits = [&](double by_reference) {
    return std::abs(by_reference - best.level) <= kSameLengths * best.level;
  };
  const bool suits_start = suits(found.start);
  const bool improved = improve(least, best);
  return {improved, improved && suits_start && suits(found.end)};
}

/// The conditions of normals also allow the opposite ones. Where a surface has these, it gets the model's tangents, and
/// the search goes on in the model's lengths; at last without a search, so that no normal is left opposite.
void FairSolve::turn_opposed(const Values& model, Best& best, FairReport& report, const Progress& progress) {
  constexpr int kMostTimes = 6;
  for (int time = 0; time <= kMostTimes; ++time) {
    Values unknowns = system_.unknowns(*best.control);
    if (normals_.hold_opposed(unknowns, system_.unknowns(model)) == 0) return;
    report.kept_plain = false;
    normals_.meet(unknowns);
    best.control = system_.control(unknowns, targets_);
    best.level = objective(*best.control);
    if (time < kMostTimes) search(model, best, report, progress);
  }
}

Values FairSolve::run(const Values& lengths, const std::optional<Values>& plain, FairReport& report,
                      const Progress& progress) {
  Best best;
  if (plain) {
    Values unknowns = system_.unknowns(*plain);
    normals_.meet(unknowns);
    best.control = system_.control(unknowns, targets_);
    best.level = objective(*best.control);
  }
  report.kept_plain = plain.has_value();
  for (int round = 0; round < options_.rounds; ++round) {
    const Values reference = round == 0 ? lengths : *best.control;
    const Progress of_round =
        progress_within(progress, static_cast<double>(round) / options_.rounds, (round + 1.0) / options_.rounds);
    const Round found = search(reference, best, report, of_round);
    if (found.improved) {
      report.kept_plain = false;
    } else if (round > 0) {
      break;
    }
    turn_opposed(lengths, best, report, progress_within(of_round, 1.0, 1.0));
    if (found.settled) break;
  }
  report.energy = position_weights_.size() == 0 ? best.level : energy_.energy(*best.control);
  return system_.control(system_.unknowns(*best.control), targets_);
}

/// Angles between the normals wanted and those of the surface.
void measure_normals(const FineMesh& fine, const FairNormals& normals, ConstValuesRef wanted, const Values& control,
                     FairReport& report) {
  report.normal_count = normals.count();
  const auto tangent = [&](Index vertex, TileValue value) {
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    visit_vertex_limit(fine.topology, fine.scheme, value, fine.topology.vertex_half_edge(vertex),
                       [&](Index of, double weight) { sum += weight * control.row(of); });
    return sum;
  };
  const auto largest = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    double angle = 0.0;
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      const Index v = normals.vertices()[i];
      const Eigen::RowVector3d n = tangent(v, TileValue::TangentU).cross(tangent(v, TileValue::TangentV));
      const Eigen::RowVector3d w = wanted.row(v).normalized();
      angle = std::max(angle, std::atan2(n.cross(w).norm(), n.dot(w)));
    }
    return angle;
  };
  report.max_angle = parallel_reduce(
      normals.count(), 0.0, largest, [](double a, double b) { return std::max(a, b); }, kBlock);
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
  if (frame.diagonal > 0.0 && options.smoothing > frame.diagonal) {
    throw Error(
        ErrorCode::BadArgument,
        "the smoothing is longer than the diagonal of the points' box, so that all of their shape would vanish; "
        "give the length of the longest bumps to smooth");
  }
  const Values wanted = frame.inwards(targets);
  const std::optional<Values> plain =
      plain_control(topology, scheme, wanted, levels, progress_within(progress, 0.0, 0.1));
  RefinedSurface start = refine(with_surface_holes(topology, scheme), scheme, wanted, levels);
  const FineMesh fine{start.topology, scheme.after_first_step(), levels};
  Scalars weights;
  if (options.smoothing > 0.0) {
    weights = smoothing_weights(topology, wanted, options.energy, options.smoothing * frame.scale);
  }
  FairSolve solve(fine, wanted, options, std::move(weights), progress_within(progress, 0.1, 0.2));
  FairReport report;
  report.levels = levels;
  Values control = solve.run(start.values, plain, report, progress_within(progress, 0.2, 0.95));
  report.plain_energy = plain ? solve.energy(*plain) : std::numeric_limits<double>::quiet_NaN();
  report.diagonal = frame.diagonal;
  const double unit = std::pow(frame.scale, 2 * order_of(options.energy) - 4);
  report.plain_energy *= unit;
  report.energy *= unit;
  measure_normals(fine, solve.normals(), options.normals, control, report);
  control = frame.outwards(control);
  // In the frame, where squares are ordinary numbers; of the control points that are handed out, rounded as they are.
  measure_positions(solve.limit(), frame.inwards(control), wanted, report);
  report.max_error /= frame.scale;
  report.rms_error /= frame.scale;
  report_progress(progress, 1.0);
  return {fine.topology, fine.scheme, std::move(control), std::move(report)};
}

}  // namespace batten
