/// \file How a fit goes on from round to round: how fair the surface has to be, and when rounds gain nothing.
#pragma once
#include "batten/fit/surface_fitter.h"

namespace batten {

/// Fairness follows the fit: it counts with the square of the distances that are left, so that noise keeps a surface
/// smooth and exact data set it free. It falls by no more than kFall a round. Distances are shares of the diameter.
class FitSchedule {
 public:
  /// rms: before the first round.
  explicit FitSchedule(double rms);

  const FitStep& step() const { return step_; }
  /// After a round.
  void note(double rms, double max);
  /// After the mesh was refined: a finer mesh bends more easily for the same fairness.
  void note_refined();
  /// True where the last rounds have gained too little.
  bool is_stuck() const { return idle_ >= kIdle; }

 private:
  static constexpr double kFall = 0.4;
  static constexpr int kIdle = 3;
  void choose(double rms);

  FitStep step_;
  double best_rms_;
  double best_max_;
  int idle_ = 0;
};

}  // namespace batten
