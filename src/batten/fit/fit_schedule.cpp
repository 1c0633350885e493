#include "batten/fit/fit_schedule.h"

#include <algorithm>

namespace batten {

namespace {

/// Fairness for the square of the distances.
constexpr double kFairnessOfSquares = 30.0;
constexpr double kLeastFairness = 1e-12;
/// How much more than fairness the evenness of the parameters counts.
constexpr double kEvenness = 100.0;
constexpr double kMostEven = 3e-2;
/// What pulls the surface to the points falls with the fairness, down to this.
constexpr double kLeastPull = 0.1;
constexpr double kPullFall = 0.8;
/// A round gains where it takes off so much of what was left.
constexpr double kGain = 0.01;
/// A finer mesh has sixteen times as little energy for the same shape.
constexpr double kOfRefined = 4.0;

}  // namespace

FitSchedule::FitSchedule(double rms) : best_rms_(rms), best_max_(rms) {
  step_.fairness = 1.0;
  step_.pull = 1.0;
  choose(rms);
}

void FitSchedule::choose(double rms) {
  const double wanted = kFairnessOfSquares * rms * rms;
  step_.fairness = std::max(kLeastFairness, std::min(step_.fairness, std::max(wanted, kFall * step_.fairness)));
  step_.evenness = std::max(step_.fairness, std::min(kMostEven, kEvenness * step_.fairness));
}

void FitSchedule::note(double rms, double max) {
  const bool gains = rms < (1.0 - kGain) * best_rms_ || max < (1.0 - kGain) * best_max_;
  idle_ = gains ? 0 : idle_ + 1;
  best_rms_ = std::min(best_rms_, rms);
  best_max_ = std::min(best_max_, max);
  step_.pull = std::max(kLeastPull, kPullFall * step_.pull);
  choose(rms);
}

void FitSchedule::note_refined() {
  step_.fairness *= kOfRefined;
  idle_ = 0;
}

}  // namespace batten
