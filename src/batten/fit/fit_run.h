/// \file The rounds of a fit.
#pragma once
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "batten/buffer.h"
#include "batten/fit/fit_errors.h"
#include "batten/fit/fit_report.h"
#include "batten/fit/fit_schedule.h"
#include "batten/fit/fit_surface.h"
#include "batten/fit/outliers.h"
#include "batten/fit/surface_fitter.h"

namespace batten {

/// The surfaces of one control mesh that were passed, of which the best is kept: of those with the fewest unsound faces
/// the nearest to the points. Unsound faces are counted only where that decides.
class PassedSurfaces {
 public:
  /// allowed: so many unsound faces count as none.
  explicit PassedSurfaces(Index allowed) : allowed_(allowed) {}

  /// A surface and what is known of it.
  struct Surface {
    Values control;
    double rms = 0.0;                   ///< share of the diameter
    std::optional<Index> unsound = {};  ///< faces, once counted
  };

  void clear() { surfaces_.clear(); }
  bool empty() const { return surfaces_.empty(); }
  /// After each round.
  void note(Surface surface);
  /// nullptr before the first one.
  const Surface* best(const SurfaceFitter& fitter);

 private:
  Index allowed_;
  std::vector<Surface> surfaces_;
};

/// Moves a surface from where it starts to the points, round by round, and refines it. Everything that is passed on
/// must outlive it.
class FitRun {
 public:
  /// The fitter is attached. settled: FitBeginning::settled. report: rounds are added to it.
  FitRun(SurfaceFitter& fitter, const FitOptions& options, FitReport& report, const OutlierFilter& filter,
         bool settled);

  /// The first rounds of the first control mesh, until they gain nothing or there are so many in all: enough to see how
  /// well it suits the points.
  void approach(int most, const Progress& progress);
  /// True where further rounds of approach() would gain nothing.
  bool has_approached() const { return approached_; }
  /// All that is left after approach(), refinements included.
  void finish(const Progress& progress);
  /// Leaves the best surface of a fit that was interrupted.
  void settle();

  /// One flag a point.
  const Buffer<std::uint8_t>& outliers() const { return outliers_; }
  /// Of the points that are no outliers, as a share of the diameter.
  double rms() const { return measured().rms; }
  /// True where the surface had to be made sound at the cost of distances.
  bool evened_out() const { return evened_out_; }
  /// Shows the surface to the options' watcher.
  void show() const;
  /// Whom to show it from now on.
  void set_watch(FrameWatcher watch) { watch_ = std::move(watch); }

 private:
  FitErrors measured() const;
  bool reached(const FitErrors& errors);
  bool has_unsound_beyond(Index most) const;
  void note_passed();
  void mend();
  void smooth_unsound();
  bool even_out();
  bool return_to_best();
  Index next_count() const;
  void finish_level(bool last, const Progress& progress);
  void go_rounds(Soundness asked, const Progress& progress) { go_rounds(asked, 0, options_.rounds, progress); }
  bool go_rounds(Soundness asked, int first, int end, const Progress& progress);
  bool leave_out_far();
  void judge();
  void lower_worst(const Progress& progress);
  void set_weights(double power);
  void go_round(Soundness asked);

  SurfaceFitter& fitter_;
  const FitOptions& options_;
  FitReport& report_;
  const OutlierFilter& filter_;
  FrameWatcher watch_;
  Buffer<std::uint8_t> far_;       ///< one flag a point, of outliers that are sure
  Scalars belonging_;              ///< of each point to the surface
  Buffer<std::uint8_t> outliers_;  ///< one flag a point, of those that rather do not belong
  FitSchedule schedule_;
  bool evened_out_ = false;
  /// So many unsound faces are as good as none: any number where a mesh that was given has some, since the shape it
  /// follows may pass through itself too.
  Index allowed_;
  PassedSurfaces passed_;
  double gain_ = 1.0;  ///< the share of the objective that the last round took off
  bool settled_;
  bool approached_ = false;
  int approach_ = 0;  ///< rounds of it
  int judged_ = 0;    ///< how often outliers were sought for the present control mesh
};

}  // namespace batten
