#include "batten/fit/fit_attempt.h"

#include <memory>
#include <utility>

#include "batten/error.h"
#include "batten/fit/dynamic_fit.h"
#include "batten/fit/fit_beginning.h"
#include "batten/fit/fit_run.h"

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

/// By springs.
FitAttempt drawn_by_springs(const Mesh& start, const PointCloud& cloud, const FitOptions& options,
                            const OutlierFilter& filter, double diameter, const Progress& progress) {
  FitReport report;
  report.diameter = diameter;
  Buffer<std::uint8_t> outliers = filter.lonely();
  const DynamicFit found = fit_dynamic(start, cloud.points, outliers, options, diameter, report, progress);
  FitAttempt made{SurfaceFitter(found.topology, found.scheme, found.control, cloud), std::move(report),
                  std::move(outliers)};
  made.fitter.attach();
  return made;
}

}  // namespace

FitAttempt make_fit(const PointCloud& cloud, const FitOptions& options, const OutlierFilter& filter, double diameter,
                    const Progress& progress) {
  const FitBeginning start = find_beginning(cloud, filter, options, progress_within(progress, 0.0, kBegun));
  if (options.method == FitMethod::Dynamic)
    return drawn_by_springs(start.mesh, cloud, options, filter, diameter, progress_within(progress, kBegun, 1.0));
  const bool found = options.creases == FitCreases::Auto && !options.initial && !start.mesh.creases.empty();
  const bool doubtful = found && options.scheme.kind == SchemeKind::CatmullClark;
  Attempt sharp(start, cloud, options, filter, diameter, progress_within(progress, kBegun, 0.25));
  const double half = doubtful ? 0.4 : kApproached;
  const bool hidden = doubtful && options.watch;
  sharp.approach(hidden, progress_within(progress, 0.25, half));
  const Progress rest = progress_within(progress, kApproached, 1.0);
  if (!doubtful || sharp.is_cancelled()) return sharp.finish(options.watch, rest);
  FitOptions smooth_options = options;
  smooth_options.creases = FitCreases::None;
  try {
    const FitBeginning other =
        find_beginning(cloud, filter, smooth_options, progress_within(progress, half, half + 0.05));
    Attempt smooth(other, cloud, smooth_options, filter, diameter, progress_within(progress, half + 0.05, half + 0.07));
    smooth.approach(hidden, progress_within(progress, half + 0.07, kApproached));
    if (smooth.rms() < sharp.rms()) return smooth.finish(options.watch, rest);
    if (smooth.is_cancelled()) sharp.cancel();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Cancelled) throw;
    sharp.cancel();
  }
  return sharp.finish(options.watch, rest);
}

}  // namespace batten
