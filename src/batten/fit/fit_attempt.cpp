#include "batten/fit/fit_attempt.h"

#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "batten/error.h"
#include "batten/fit/dynamic_fit.h"
#include "batten/fit/fit_beginning.h"
#include "batten/fit/fit_levels.h"
#include "batten/fit/fit_run.h"
#include "batten/fit/followed_cloud.h"

namespace batten {

namespace {

/// The part of the progress that a beginning and the first rounds take.
constexpr double kBegun = 0.2;
constexpr double kApproached = 0.6;
/// That of the first of several draws, which is nearly always the only one.
constexpr double kFirstDraw = 0.85;

/// An attempt on its way.
class Attempt {
 public:
  Attempt(const FitBeginning& start, const PointCloud& cloud, const FitOptions& options, const OutlierFilter& filter,
          double diameter, const Progress& progress)
      : made_(std::make_unique<FitAttempt>(FitAttempt{SurfaceFitter(
            Topology(start.mesh), options.scheme, start.mesh.points, cloud, progress_within(progress, 0.0, 0.5))})) {
    made_->report.diameter = diameter;
    made_->fitter.attach(progress_within(progress, 0.5, 1.0));
    run_ = std::make_unique<FitRun>(made_->fitter, options, made_->report, filter, start.settled);
  }

  /// The first rounds, at most so many in all; `hidden`: a watcher is not shown them before the attempt is chosen.
  void approach(int most, bool hidden, const Progress& progress) {
    if (hidden) run_->set_watch([this](const SurfaceFrame& frame) { frames_.add(frame); });
    go([&] { run_->approach(most, progress); });
  }

  double rms() const { return run_->rms(); }
  const Buffer<std::uint8_t>& outliers() const { return run_->outliers(); }
  bool is_cancelled() const { return made_->report.end == FitEnd::Cancelled; }
  bool has_rounds() const { return !made_->report.rounds.empty(); }

  /// Shows what was hidden, and makes the rounds that are left.
  FitAttempt finish(const FrameWatcher& watch, const Progress& progress) {
    if (watch) {
      for (Index i = 0; i < frames_.size(); ++i) watch(frames_.frame(i));
    }
    run_->set_watch(watch);
    if (!is_cancelled()) go([&] { run_->finish(progress); });
    if (is_cancelled()) run_->settle();
    run_->show();
    made_->outliers = run_->outliers();
    made_->rms = run_->rms();
    made_->evened_out = run_->evened_out();
    return std::move(*made_);
  }

  /// Ends the rounds here.
  void cancel() { made_->report.end = FitEnd::Cancelled; }

 private:
  template <typename Rounds>
  void go(const Rounds& rounds) {
    try {
      rounds();
    } catch (const Error& error) {
      if (error.code() != ErrorCode::Cancelled || !has_rounds()) throw;
      cancel();
    }
  }

  std::unique_ptr<FitAttempt> made_;
  std::unique_ptr<FitRun> run_;
  SurfaceFilm frames_;
};

/// What all attempts of a fit have in common.
struct FitTask {
  const PointCloud& cloud;
  const FitOptions& options;
  const OutlierFilter& filter;
  double diameter;
};

/// Finds outliers near the surface by the first rounds of a smooth fit, and once more without those: they bend the
/// first mesh and the normals of the points beside them. attempt: the last one that has come to an end.
void find_outliers(const FitTask& task, const FitOptions& smooth, FollowedCloud& points,
                   std::unique_ptr<Attempt>& attempt, const Progress& progress) {
  constexpr int kPasses = 2;
  Buffer<std::uint8_t> outliers = task.filter.lonely();
  for (int pass = 0; pass < kPasses; ++pass) {
    const Progress part = progress_within(progress, static_cast<double>(pass) / kPasses, (pass + 1.0) / kPasses);
    const FitBeginning start = find_beginning(points.followed(), task.filter.spacing(), smooth, LoopStart::Plain,
                                              progress_within(part, 0.0, 0.3));
    auto next = std::make_unique<Attempt>(start, points.all(), smooth, task.filter, task.diameter,
                                          progress_within(part, 0.3, 0.4));
    next->approach(smooth.rounds, false, progress_within(part, 0.4, 1.0));
    attempt = std::move(next);
    if (attempt->is_cancelled() || attempt->outliers() == outliers) return;
    outliers = attempt->outliers();
    points = FollowedCloud(task.cloud, outliers);
  }
}

/// The first rounds of an attempt with creases and of one without, of which the one that stays nearer to the points
/// goes on. Few rounds of both tell where one is clearly better.
FitAttempt better_attempt(const FitTask& task, const FollowedCloud& points, Attempt& sharp, const Progress& progress) {
  constexpr int kFewRounds = 8;
  constexpr double kClearly = 1.3;
  constexpr double kEarned = 1.1;  // creases that gain less are chance
  const FitOptions& options = task.options;
  FitOptions smooth_options = options;
  smooth_options.creases = FitCreases::None;
  const bool hidden = static_cast<bool>(options.watch);
  const Progress first = progress_within(progress, 0.0, 0.5);
  const Progress rest = progress_within(progress, 0.5, 1.0);
  sharp.approach(kFewRounds, hidden, progress_within(first, 0.0, 0.2));
  if (sharp.is_cancelled()) return sharp.finish(options.watch, rest);
  try {
    const FitBeginning other = find_beginning(points.followed(), task.filter.spacing(), smooth_options,
                                              LoopStart::Moved, progress_within(first, 0.2, 0.3));
    Attempt smooth(other, points.all(), smooth_options, task.filter, task.diameter, progress_within(first, 0.3, 0.35));
    smooth.approach(kFewRounds, hidden, progress_within(first, 0.35, 0.5));
    const auto cost = [&](const Attempt& attempt) { return (&attempt == &sharp ? kEarned : 1.0) * attempt.rms(); };
    const bool sharp_leads = cost(sharp) <= cost(smooth);
    Attempt& leading = sharp_leads ? sharp : smooth;
    Attempt& behind = sharp_leads ? smooth : sharp;
    const bool clear = cost(behind) > kClearly * cost(leading);
    if (!leading.is_cancelled())
      leading.approach(options.rounds, hidden, progress_within(first, 0.5, clear ? 1.0 : 0.75));
    if (!clear && !leading.is_cancelled()) behind.approach(options.rounds, hidden, progress_within(first, 0.75, 1.0));
    Attempt& chosen = clear || cost(leading) <= cost(behind) ? leading : behind;
    if (leading.is_cancelled() || behind.is_cancelled()) chosen.cancel();
    return chosen.finish(options.watch, rest);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Cancelled) throw;
    sharp.cancel();
  }
  return sharp.finish(options.watch, rest);
}

/// Makes all rounds, with creases and without where those that are found are doubtful.
FitAttempt best_attempt(const FitTask& task, const FollowedCloud& points, const Progress& progress) {
  const FitOptions& options = task.options;
  const FitBeginning start = find_beginning(points.followed(), task.filter.spacing(), options, LoopStart::Moved,
                                            progress_within(progress, 0.0, kBegun));
  const bool found = options.creases == FitCreases::Auto && !options.initial && !start.mesh.creases.empty();
  Attempt attempt(start, points.all(), options, task.filter, task.diameter, progress_within(progress, kBegun, 0.25));
  if (found && options.scheme.kind == SchemeKind::CatmullClark)
    return better_attempt(task, points, attempt, progress_within(progress, 0.25, 1.0));
  attempt.approach(options.rounds, false, progress_within(progress, 0.25, kApproached));
  return attempt.finish(options.watch, progress_within(progress, kApproached, 1.0));
}

/// Which control points get stuck and fold is chance, and another first mesh another draw. Of those whose surfaces are
/// sound the nearest to the points.
FitAttempt best_draw(const FitTask& task, const FollowedCloud& points, const Progress& progress) {
  constexpr std::array<double, 2> kShares{0.97, 0.94};
  const FitOptions& options = task.options;
  const bool found = !options.initial && options.start != FitStart::Sphere;
  const double first = found ? kFirstDraw : 1.0;
  FitAttempt made = best_attempt(task, points, progress_within(progress, 0.0, first));
  FitOptions trial = options;
  trial.watch = {};
  try {
    bool again = found && made.evened_out && made.report.end != FitEnd::Cancelled;
    bool other = false;
    for (std::size_t i = 0; i < kShares.size() && again; ++i) {
      const auto share = [&](std::size_t drawn) {
        return first + (1.0 - first) * static_cast<double>(drawn) / kShares.size();
      };
      trial.vertices = static_cast<Index>(std::lround(kShares[i] * options.vertices.value_or(kUsualFitVertices)));
      FitAttempt next = best_attempt({task.cloud, trial, task.filter, task.diameter}, points,
                                     progress_within(progress, share(i), share(i + 1)));
      if (next.report.end == FitEnd::Cancelled) break;
      again = next.evened_out;
      if (!(std::pair(next.fitter.unsound_faces(), next.rms) < std::pair(made.fitter.unsound_faces(), made.rms)))
        continue;
      made = std::move(next);
      other = true;
    }
    if (other && options.watch) options.watch({made.fitter.topology(), made.fitter.scheme(), made.fitter.control()});
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Cancelled) throw;
  }
  return made;
}

/// By springs.
FitAttempt drawn_by_springs(const FitTask& task, const FollowedCloud& points, const Progress& progress) {
  const FitBeginning start = find_beginning(points.followed(), task.filter.spacing(), task.options, LoopStart::Moved,
                                            progress_within(progress, 0.0, kBegun));
  FitReport report;
  report.diameter = task.diameter;
  Buffer<std::uint8_t> outliers = task.filter.lonely();
  const DynamicFit found = fit_dynamic(start.mesh, task.cloud.points, outliers, task.options, task.diameter, report,
                                       progress_within(progress, kBegun, 1.0));
  FitAttempt made{SurfaceFitter(found.topology, found.scheme, found.control, points.all()), std::move(report),
                  std::move(outliers)};
  made.fitter.attach();
  return made;
}

}  // namespace

FitAttempt make_fit(const PointCloud& cloud, const FitOptions& options, const OutlierFilter& filter, double diameter,
                    const Progress& progress) {
  const FitTask task{cloud, options, filter, diameter};
  FollowedCloud points(cloud, filter.lonely(), progress_within(progress, 0.0, 0.05));
  if (options.method == FitMethod::Dynamic) return drawn_by_springs(task, points, progress_within(progress, 0.05, 1.0));
  const bool search = filter.has_lonely() && !options.initial;
  const double searched = search ? 0.35 : 0.05;
  FitOptions smooth = options;
  smooth.creases = FitCreases::None;
  smooth.watch = {};
  std::unique_ptr<Attempt> attempt;
  try {
    if (search) find_outliers(task, smooth, points, attempt, progress_within(progress, 0.05, searched));
    if (attempt == nullptr || !attempt->is_cancelled())
      return best_draw(task, points, progress_within(progress, searched, 1.0));
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Cancelled || attempt == nullptr) throw;
    attempt->cancel();
  }
  return attempt->finish(options.watch, progress);
}

}  // namespace batten
