#include "batten/fit/fit_schedule.h"

#include <algorithm>

namespace batten {

namespace {

/// Fairness for the square of the distances.
constexpr double kFairnessOfSquares = 30.0;
constexpr double kMostFair = 1.0;
constexpr double kLeastFairness = 1e-14;
constexpr double kFall = 0.4;
/// How much more than fairness the evenness of the parameters counts.
constexpr double kEvenness = 100.0;
constexpr double kEvennessOfSettled = 50.0;
constexpr double kMostEven = 3e-2;
/// What draws the surface to the points falls with the distances, as parts of the points' spacing.
constexpr double kPullOfDistance = 1.0;
constexpr double kPullFall = 0.8;
/// A round gains where it takes off so much of what was left; with more points than so many, in proportion more: it
/// takes as much longer.
constexpr double kGain = 0.02;
constexpr double kPointsOfGain = 20000.0;
constexpr double kMostGain = 0.1;
/// So many rounds without gain in a row end a series, and fewer where rounds are long.
constexpr int kIdle = 3;
constexpr int kIdleOfLong = 2;
/// A finer mesh has sixteen times as little energy for the same shape.
constexpr double kOfRefined = 4.0;

}  // namespace

double FitSchedule::wanted_pull(const FitErrors& errors) const {
  return spacing_ > 0.0 ? kPullOfDistance * errors.bulk / spacing_ : 1.0;
}

FitSchedule::FitSchedule(const FitErrors& errors, double spacing, Eigen::Index points, bool settled)
    : best_(errors),
      spacing_(spacing),
      least_gain_(std::clamp(kGain * static_cast<double>(points) / kPointsOfGain, kGain, kMostGain)),
      most_idle_(least_gain_ > kGain ? kIdleOfLong : kIdle),
      evenness_(settled ? kEvennessOfSettled : kEvenness) {
  step_.pull = settled ? std::min(1.0, wanted_pull(errors)) : 1.0;
  step_.fairness = std::min(kMostFair, std::max(kLeastFairness, kFairnessOfSquares * errors.bulk * errors.bulk));
  choose(errors);
}

void FitSchedule::choose(const FitErrors& errors) {
  const double wanted = kFairnessOfSquares * errors.bulk * errors.bulk;
  step_.fairness = std::max(kLeastFairness, std::min(step_.fairness, std::max(wanted, kFall * step_.fairness)));
  step_.evenness = std::max(step_.fairness, std::min(kMostEven, evenness_ * step_.fairness));
  step_.pull = std::min(step_.pull, std::max(wanted_pull(errors), kPullFall * step_.pull));
}

void FitSchedule::note(const FitErrors& errors) {
  // Where rounds are long, of what is left in all: the nearest points alone may gain for long.
  const double of_bulk = least_gain_ > kGain ? best_.rms : best_.bulk;
  const double most = 1.0 - least_gain_;
  const bool gains = errors.rms < most * best_.rms || errors.bulk < best_.bulk - least_gain_ * of_bulk ||
                     errors.max < most * best_.max;
  idle_ = gains ? 0 : idle_ + 1;
  best_.rms = std::min(best_.rms, errors.rms);
  best_.bulk = std::min(best_.bulk, errors.bulk);
  best_.max = std::min(best_.max, errors.max);
  choose(errors);
}

void FitSchedule::note_restart(const FitErrors& errors) {
  best_ = errors;
  idle_ = 0;
}

void FitSchedule::note_refined() {
  step_.fairness *= kOfRefined;
  idle_ = 0;
}

}  // namespace batten
