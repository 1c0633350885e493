#include "batten/fit/fit_attempt.h"

#include <memory>
#include <utility>

#include "batten/error.h"
#include "batten/fit/dynamic_fit.h"
#include "batten/fit/fit_beginning.h"
#include "batten/fit/fit_run.h"
#include "batten/fit/followed_cloud.h"

namespace batten {

namespace {

/// The part of the progress that a beginning and the first rounds take.
constexpr double kBegun = 0.2;
constexpr double kApproached = 0.6;

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

  /// The first rounds; `hidden`: a watcher is not shown them before the attempt is chosen.
  void approach(bool hidden, const Progress& progress) {
    if (hidden) run_->set_watch([this](const SurfaceFrame& frame) { frames_.add(frame); });
    go([&] { run_->approach(progress); });
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
    next->approach(false, progress_within(part, 0.4, 1.0));
    attempt = std::move(next);
    if (attempt->is_cancelled() || attempt->outliers() == outliers) return;
    outliers = attempt->outliers();
    points = FollowedCloud(task.cloud, outliers);
  }
}

/// Makes all rounds, with creases and without where those that are found are doubtful.
FitAttempt best_attempt(const FitTask& task, const FollowedCloud& points, const Progress& progress) {
  constexpr double kEarned = 1.1;  // creases that gain less are chance
  const FitOptions& options = task.options;
  const double spacing = task.filter.spacing();
  const FitBeginning start =
      find_beginning(points.followed(), spacing, options, LoopStart::Moved, progress_within(progress, 0.0, kBegun));
  const bool found = options.creases == FitCreases::Auto && !options.initial && !start.mesh.creases.empty();
  const bool doubtful = found && options.scheme.kind == SchemeKind::CatmullClark;
  Attempt sharp(start, points.all(), options, task.filter, task.diameter, progress_within(progress, kBegun, 0.25));
  const double half = doubtful ? 0.4 : kApproached;
  const bool hidden = doubtful && options.watch;
  sharp.approach(hidden, progress_within(progress, 0.25, half));
  const Progress rest = progress_within(progress, kApproached, 1.0);
  if (!doubtful || sharp.is_cancelled()) return sharp.finish(options.watch, rest);
  FitOptions smooth_options = options;
  smooth_options.creases = FitCreases::None;
  try {
    const FitBeginning other = find_beginning(points.followed(), spacing, smooth_options, LoopStart::Moved,
                                              progress_within(progress, half, half + 0.05));
    Attempt smooth(other, points.all(), smooth_options, task.filter, task.diameter,
                   progress_within(progress, half + 0.05, half + 0.07));
    smooth.approach(hidden, progress_within(progress, half + 0.07, kApproached));
    if (smooth.rms() < kEarned * sharp.rms()) return smooth.finish(options.watch, rest);
    if (smooth.is_cancelled()) sharp.cancel();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Cancelled) throw;
    sharp.cancel();
  }
  return sharp.finish(options.watch, rest);
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
      return best_attempt(task, points, progress_within(progress, searched, 1.0));
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Cancelled || attempt == nullptr) throw;
    attempt->cancel();
  }
  return attempt->finish(options.watch, progress);
}

}  // namespace batten
