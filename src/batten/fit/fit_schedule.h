/// \file How a fit goes on from round to round: how fair the surface has to be, and when rounds gain nothing.
#pragma once
#include <Eigen/Core>

#include "batten/fit/fit_errors.h"
#include "batten/fit/surface_fitter.h"

namespace batten {

/// Fairness follows the fit: it counts with the square of the distances that are left, so that noise keeps a surface
/// smooth and exact data set it free. It falls by no more than so much a round.
class FitSchedule {
 public:
  /// Before the first round. spacing: of so many points, as a share of the diameter. settled: the surface is near the
  /// points already: it is drawn to them no more than its distances ask for, and its parameters are even enough to move
  /// more freely.
  FitSchedule(const FitErrors& errors, double spacing, Eigen::Index points, bool settled = false);

  const FitStep& step() const { return step_; }
  /// After a round.
  void note(const FitErrors& errors);
  /// After the mesh was refined: a finer mesh bends more easily for the same fairness.
  void note_refined();
  /// After a change that makes what was reached before count no longer, as other outliers.
  void note_restart(const FitErrors& errors);
  /// True where the last rounds have gained too little.
  bool is_stuck() const { return idle_ >= most_idle_; }

 private:
  void choose(const FitErrors& errors);
  double wanted_pull(const FitErrors& errors) const;

  FitStep step_;
  FitErrors best_;
  double spacing_;
  double least_gain_;
  int most_idle_;
  double evenness_;  ///< of the parameters, for what fairness counts
  int idle_ = 0;
};

}  // namespace batten
