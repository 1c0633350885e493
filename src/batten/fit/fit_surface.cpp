#include "batten/fit/fit_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "batten/error.h"
#include "batten/fit/cloud_samples.h"
#include "batten/fit/dynamic_fit.h"
#include "batten/fit/enclosing_sphere.h"
#include "batten/fit/fit_beginning.h"
#include "batten/fit/fit_distances.h"
#include "batten/fit/fit_errors.h"
#include "batten/fit/fit_levels.h"
#include "batten/fit/fit_schedule.h"
#include "batten/fit/outliers.h"
#include "batten/fit/surface_fitter.h"
#include "batten/fit/thin_cloud.h"
#include "batten/mesh/checked_values.h"
#include "batten/refine/refined_values.h"

namespace batten {

namespace {

/// In the end a point counts with this power of its distance.
constexpr double kWorstPower = 2.0;

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
}

/// The points that the rounds work with, with normals: in the order of their coordinates, so that the order in which
/// they are given changes no bit, and one at each place.
struct WorkingCloud {
  Buffer<Index> rows;  ///< in the whole cloud
  PointCloud cloud;
};

WorkingCloud working_cloud(const PointCloud& cloud, const FitOptions& options, const Progress& progress) {
  // Moves of a Loop mesh ask for all that is known of thin parts.
  const Index least = options.scheme.kind == SchemeKind::Loop ? 20000 : 10000;
  constexpr Index kOfVertex = 12;
  const Index start = options.initial ? options.initial->vertex_count() : 0;
  const Index vertices = std::max(start, options.vertices.value_or(kUsualFitVertices));
  const Index most = std::max(least, kOfVertex * std::min(vertices, std::numeric_limits<Index>::max() / kOfVertex));
  const Buffer<Index> thin = thinned_rows(cloud.points, most);
  WorkingCloud working;
  const Points normals = cloud.normals.rows() > 0 ? Points(cloud.normals(thin, Eigen::all)) : Points(0, 3);
  for (const Index place : sorted_rows(cloud.points(thin, Eigen::all), normals)) {
    const Index row = thin[place];
    if (working.rows.empty() || cloud.points.row(row) != cloud.points.row(working.rows.back()))
      working.rows.push_back(row);
  }
  working.cloud.points = cloud.points(working.rows, Eigen::all);
  working.cloud.normals = cloud.normals.rows() > 0 ? Points(cloud.normals(working.rows, Eigen::all))
                                                   : estimate_normals(working.cloud.points, {}, progress);
  return working;
}

/// The rounds of one fit.
class FitRun {
 public:
  FitRun(SurfaceFitter& fitter, const FitOptions& options, FitReport& report, const OutlierFilter& filter, bool settled)
      : fitter_(fitter),
        options_(options),
        report_(report),
        filter_(filter),
        outliers_(filter.lonely()),
        schedule_(measured(), filter.spacing() / report.diameter, settled),
        settled_(settled) {
    set_weights(0.0);
    if (settled) note_best();
  }

  /// All rounds and refinements.
  void go(const Progress& progress) {
    const Index most = most_fit_vertices(options_);
    const int levels = fit_level_count(fitter_.topology(), fitter_.scheme().kind, most);
    const auto share = [levels](int level) { return std::min(static_cast<double>(level) / levels, 1.0); };
    show();
    for (int level = 0;; ++level) {
      const bool last = next_count() > most;
      go_level(last, progress_within(progress, share(level), share(level + 1)));
      if (last || report_.end == FitEnd::Tolerance) return;
      fitter_.refine();
      fitter_.attach();
      best_.reset();
      judged_ = 0;
      schedule_.note_refined();
    }
  }

  /// Leaves the best surface of a fit that was interrupted.
  void settle() {
    if (best_) fitter_.move_to(best_->control);
    fitter_.attach();
  }

  const Buffer<std::uint8_t>& outliers() const { return outliers_; }
  /// Of the points that are no outliers, as a share of the diameter.
  double rms() const { return measured().rms; }

  void show() const {
    if (options_.watch) options_.watch({fitter_.topology(), fitter_.scheme(), fitter_.control()});
  }

 private:
  FitErrors measured() const { return fit_errors(fitter_.distances(), outliers_, report_.diameter); }

  bool reached(const FitErrors& errors) {
    if (!(options_.tolerance > 0.0) || !(errors.max * report_.diameter <= options_.tolerance)) return false;
    if (fitter_.unsound_faces() > 0) return false;
    report_.end = FitEnd::Tolerance;
    return true;
  }

  /// Keeps the surface if it is the best so far: of those with the fewest unsound faces the nearest to the points.
  void note_best() {
    const double rms = measured().rms;
    if (best_ && best_->unsound == 0 && !(rms < best_->rms)) return;
    const Index unsound = fitter_.unsound_faces();
    if (!best_ || unsound < best_->unsound || (unsound == best_->unsound && rms < best_->rms))
      best_ = {fitter_.control(), unsound, rms};
  }

  /// Relaxes the surface where it is not sound, and goes on from there until it is.
  void mend() {
    constexpr int kRounds = 10;
    for (int round = 0; round < kRounds && fitter_.hold_unsound() > 0; ++round) {
      if (!fitter_.relax(Soundness::Unfolded)) return;
      fitter_.attach();
      go_round(Soundness::Unfolded);
      note_best();
    }
  }

  /// Goes back to the best surface of this control mesh; false if that is the last one.
  bool return_to_best() {
    if (!best_ || best_->control == fitter_.control()) return false;
    fitter_.move_to(best_->control);
    fitter_.attach();
    schedule_.note_restart(measured());
    return true;
  }

  Index next_count() const { return refined_vertex_count(fitter_.topology(), fitter_.scheme().kind); }

  /// All rounds of one control mesh. On the way to the points the surface may pass through itself: held back from that
  /// it would often stay where it is. Rounds that start from the best whole surface then keep it so.
  void go_level(bool last, const Progress& progress) {
    if (settled_) {
      go_rounds(Soundness::Whole, progress_within(progress, 0.0, 0.5));
      return_to_best();
      if (last && report_.end == FitEnd::Budget) lower_worst(progress_within(progress, 0.5, 1.0));
      return;
    }
    go_rounds(Soundness::Unfolded, progress_within(progress, 0.0, 0.5));
    mend();
    if (return_to_best() && last && report_.end != FitEnd::Tolerance) {
      go_rounds(Soundness::Whole, progress_within(progress, 0.5, 0.7));
      return_to_best();
    }
    if (last && report_.end == FitEnd::Budget) lower_worst(progress_within(progress, 0.7, 1.0));
  }

  void go_rounds(Soundness asked, const Progress& progress) {
    report_.end = FitEnd::Rounds;
    for (int round = 0; round < options_.rounds; ++round) {
      report_progress(progress, static_cast<double>(round) / options_.rounds);
      go_round(asked);
      const FitErrors errors = measured();
      schedule_.note(errors);
      note_best();
      if (reached(errors)) {
        best_ = {fitter_.control(), 0, errors.rms};
        return;
      }
      if (!schedule_.is_stuck()) continue;
      if (!settled_ && leave_out_far()) continue;
      report_.end = FitEnd::Budget;
      return;
    }
  }

  /// Judges anew which points are outliers; true where that changes.
  bool leave_out_far() {
    Buffer<std::uint8_t> flags = filter_.lonely();
    filter_.add_far(fitter_.distances(), flags);
    if (judged_ == kJudgements || flags == outliers_) return false;
    ++judged_;
    outliers_ = std::move(flags);
    set_weights(0.0);
    best_.reset();
    schedule_.note_restart(measured());
    return true;
  }

  /// Points count the more the farther away they are; of all rounds the surface with the least maximum is kept whose
  /// RMS has not grown too much.
  void lower_worst(const Progress& progress) {
    // Where points are many, one alone is rarely far away, and rounds are long.
    constexpr Eigen::Index kPointsInAll = 60000;
    const auto rounds = static_cast<int>(std::clamp<Eigen::Index>(kPointsInAll / fitter_.distances().size(), 4, 24));
    constexpr double kExact = 1e-10;
    constexpr double kMostGrowth = 1.1;
    FitErrors best = measured();
    if (best.rms < kExact) return;
    const double most = kMostGrowth * best.rms;
    const Index unsound = fitter_.unsound_faces();
    best_ = {fitter_.control(), unsound, best.rms};
    for (int round = 0; round < rounds; ++round) {
      report_progress(progress, static_cast<double>(round) / rounds);
      set_weights(kWorstPower);
      go_round(Soundness::Unfolded);
      const FitErrors errors = measured();
      if (!(errors.max < best.max) || errors.rms > most || fitter_.unsound_faces() > unsound) continue;
      best = errors;
      best_->control = fitter_.control();
      if (reached(errors)) break;
    }
    settle();
  }

  /// Outliers count nothing, others by a power of their distance; half of it is what they counted before.
  void set_weights(double power) {
    constexpr double kMost = 100.0;
    const double rms = measured().rms * report_.diameter;
    Scalars weights = fitter_.weights();
    for (Eigen::Index i = 0; i < weights.size(); ++i) {
      const double share = rms > 0.0 ? fitter_.distances()[i] / rms : 1.0;
      const double wanted = power > 0.0 ? std::min(kMost, 0.5 + 0.5 * std::pow(share, power)) : 1.0;
      weights[i] = outliers_[static_cast<std::size_t>(i)] != 0 ? 0.0
                   : power > 0.0                               ? 0.5 * (weights[i] + wanted)
                                                               : wanted;
    }
    fitter_.set_weights(std::move(weights));
  }

  /// Moves by a step, or by a part of it that lowers the objective.
  void go_round(Soundness asked) {
    constexpr int kHalvings = 3;
    constexpr double kGain = 0.03;
    const Stopwatch watch;
    FitRound round;
    const FitStep& step = schedule_.step();
    if (gain_ < kGain && fitter_.relax(asked)) fitter_.attach();
    const Values before = fitter_.control();
    SolveReport solved;
    Values move = fitter_.find_step(step, &solved);
    round.objective = fitter_.objective(step.fairness);
    for (int halving = 0; halving <= kHalvings; ++halving) {
      if (halving == kHalvings) move.setZero();
      fitter_.move_to(fitter_.stepped(before, move, asked));
      fitter_.attach();
      round.after = fitter_.objective(step.fairness);
      if (round.after <= round.objective) break;
      move *= 0.5;
    }
    gain_ = 1.0 - round.after / round.objective;
    const FitErrors errors = measured();
    round.vertices = fitter_.topology().vertex_count();
    round.fairness = step.fairness;
    round.max = errors.max * report_.diameter;
    round.rms = errors.rms * report_.diameter;
    round.iterations = solved.iterations;
    round.seconds = watch.seconds();
    report_.rounds.push_back(round);
    show();
  }

  SurfaceFitter& fitter_;
  const FitOptions& options_;
  FitReport& report_;
  const OutlierFilter& filter_;
  Buffer<std::uint8_t> outliers_;
  FitSchedule schedule_;
  /// What was best of a control mesh.
  struct BestSurface {
    Values control;
    Index unsound;  ///< faces
    double rms;     ///< share of the diameter
  };
  std::optional<BestSurface> best_;
  double gain_ = 1.0;  ///< the share of the objective that the last round took off
  bool settled_;
  static constexpr int kJudgements = 3;
  int judged_ = 0;  ///< how often outliers were sought for the present control mesh
};

/// What came of one beginning.
struct FitAttempt {
  SurfaceFitter fitter;
  FitReport report = {};
  Buffer<std::uint8_t> outliers = {};
  double rms = 0.0;  ///< share of the diameter
};

/// The same by springs.
FitAttempt drawn_by_springs(const Mesh& start, const PointCloud& known, const FitOptions& options,
                            const OutlierFilter& filter, double diameter, const Progress& progress) {
  FitReport report;
  report.diameter = diameter;
  Buffer<std::uint8_t> outliers = filter.lonely();
  const DynamicFit found = fit_dynamic(start, known.points, outliers, options, diameter, report, progress);
  FitAttempt made{SurfaceFitter(found.topology, found.scheme, found.control, known), std::move(report),
                  std::move(outliers)};
  made.fitter.attach();
  made.rms = fit_errors(made.fitter.distances(), made.outliers, diameter).rms;
  return made;
}

FitAttempt attempt(const PointCloud& known, const FitOptions& options, const OutlierFilter& filter, double diameter,
                   const Progress& progress) {
  const FitBeginning start = find_beginning(known, filter, options, progress_within(progress, 0.0, 0.2));
  if (options.method == FitMethod::Dynamic)
    return drawn_by_springs(start.mesh, known, options, filter, diameter, progress_within(progress, 0.2, 1.0));
  FitAttempt made{SurfaceFitter(Topology(start.mesh), options.scheme, start.mesh.points, known,
                                progress_within(progress, 0.2, 0.22))};
  made.report.diameter = diameter;
  made.fitter.attach(progress_within(progress, 0.22, 0.25));
  FitRun run(made.fitter, options, made.report, filter, start.settled);
  try {
    run.go(progress_within(progress, 0.25, 1.0));
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Cancelled || made.report.rounds.empty()) throw;
    made.report.end = FitEnd::Cancelled;
    run.settle();
  }
  run.show();
  made.outliers = run.outliers();
  made.rms = run.rms();
  return made;
}

/// True where one surface has fewer faces that are not sound, or as many and lies nearer to the points.
bool is_better(const FitAttempt& one, const FitAttempt& other) {
  const Index of_one = one.fitter.unsound_faces();
  const Index of_other = other.fitter.unsound_faces();
  if (of_one != of_other) return of_one < of_other;
  return one.rms < other.rms;
}

/// Creases that were found under Catmull-Clark stay only where the surface is better with them than without: the edges
/// of quads may not follow the sharp edges of few points. Loop's moves have judged them one by one.
FitAttempt judged_attempt(const PointCloud& known, const FitOptions& options, const OutlierFilter& filter,
                          double diameter, const Progress& progress) {
  // Most fits end with the first attempt.
  constexpr double kFirst = 0.9;
  FitAttempt made = attempt(known, options, filter, diameter, progress_within(progress, 0.0, kFirst));
  const bool found = options.creases == FitCreases::Auto && !options.initial && made.fitter.topology().has_creases();
  if (!found || options.scheme.kind == SchemeKind::Loop || made.report.end == FitEnd::Cancelled) return made;
  FitOptions smooth = options;
  smooth.creases = FitCreases::None;
  SurfaceFilm rounds;  // which are shown only if they count
  if (options.watch) smooth.watch = [&](const SurfaceFrame& frame) { rounds.add(frame); };
  try {
    FitAttempt other = attempt(known, smooth, filter, diameter, progress_within(progress, kFirst, 1.0));
    if (other.report.end != FitEnd::Cancelled && is_better(other, made)) {
      for (Index i = 0; i < rounds.size(); ++i) options.watch(rounds.frame(i));
      return other;
    }
    made.report.end = other.report.end == FitEnd::Cancelled ? FitEnd::Cancelled : made.report.end;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Cancelled) throw;
    made.report.end = FitEnd::Cancelled;
  }
  return made;
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
  const WorkingCloud working = working_cloud(cloud, options, progress_within(progress, 0.0, 0.05));
  const PointCloud& known = working.cloud;
  const OutlierFilter filter(known.points, progress_within(progress, 0.05, 0.07));
  FitAttempt made = judged_attempt(known, options, filter, report.diameter, progress_within(progress, 0.07, 1.0));
  SurfaceFitter& fitter = made.fitter;
  const Buffer<std::uint8_t>& left_out = made.outliers;
  report = std::move(made.report);
  Scalars distances(cloud.points.rows());
  Buffer<std::uint8_t> outliers(static_cast<std::size_t>(cloud.points.rows()));
  report.spacing = filter.spacing();
  if (known.points.rows() == cloud.points.rows()) {
    for (std::size_t i = 0; i < left_out.size(); ++i) {
      distances[working.rows[i]] = fitter.distances()[static_cast<Eigen::Index>(i)];
      outliers[working.rows[i]] = left_out[i];
    }
  } else {
    distances = measure_to_surface(fitter, cloud.points);
    report.spacing = sampled_spacing(cloud.points, filter.spacing());
    outliers = filter.far_of(cloud.points, distances, fitter.distances(), report.spacing);
  }
  report.to_surface = summarize_followed(distances, outliers, report.outliers);
  report.to_points = measure_to_points(fitter);
  report.unsound = fitter.unsound_faces();
  report.seconds = watch.seconds();
  Mesh mesh = frame_mesh({fitter.topology(), fitter.scheme(), fitter.control()});
  return {std::move(mesh), fitter.topology(), fitter.scheme(), std::move(distances), std::move(report)};
}

}  // namespace batten
