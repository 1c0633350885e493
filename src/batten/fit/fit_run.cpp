#include "batten/fit/fit_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "batten/fit/fit_levels.h"
#include "batten/refine/refined_values.h"
#include "batten/solve/solver.h"

namespace batten {

namespace {

/// In the end a point counts with this power of its distance.
constexpr double kWorstPower = 2.0;
constexpr int kJudgements = 3;
constexpr Index kAnyNumber = std::numeric_limits<Index>::max();

}  // namespace

void PassedSurfaces::note(Surface surface) { surfaces_.push_back(std::move(surface)); }

const PassedSurfaces::Surface* PassedSurfaces::best(const SurfaceFitter& fitter) {
  if (surfaces_.empty()) return nullptr;
  std::stable_sort(surfaces_.begin(), surfaces_.end(),
                   [](const Surface& a, const Surface& b) { return a.rms < b.rms; });
  std::size_t best = 0;
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    Surface& surface = surfaces_[i];
    if (!surface.unsound) surface.unsound = allowed_ == kAnyNumber ? 0 : fitter.unsound_faces(surface.control);
    if (std::max(allowed_, *surface.unsound) < std::max(allowed_, *surfaces_[best].unsound)) best = i;
    if (*surface.unsound <= allowed_) break;
  }
  std::swap(surfaces_.front(), surfaces_[best]);
  surfaces_.resize(1);
  return &surfaces_.front();
}

FitRun::FitRun(SurfaceFitter& fitter, const FitOptions& options, FitReport& report, const OutlierFilter& filter,
               bool settled)
    : fitter_(fitter),
      options_(options),
      report_(report),
      filter_(filter),
      watch_(options.watch),
      far_(filter.lonely()),
      outliers_(far_),
      schedule_(measured(), filter.spacing() / report.diameter, fitter.distances().size(), settled),
      allowed_(options.initial && fitter.unsound_faces() > 0 ? kAnyNumber : 0),
      passed_(allowed_),
      settled_(settled) {
  judge();
  if (settled) note_passed();
}

void FitRun::approach(int most, const Progress& progress) {
  if (approach_ == 0) show();
  if (approach_ == 0 && settled_) {
    smooth_unsound();
    schedule_.note_restart(measured());
  }
  const int end = std::min(most, options_.rounds);
  if (approached_ || approach_ >= end) return;
  approached_ =
      go_rounds(settled_ ? Soundness::Whole : Soundness::Unfolded, approach_, end, progress) || end == options_.rounds;
  approach_ = end;
}

void FitRun::finish(const Progress& progress) {
  const Index most = most_fit_vertices(options_);
  const int levels = fit_level_count(fitter_.topology(), fitter_.scheme().kind, most);
  const auto share = [levels](int level) { return std::min(static_cast<double>(level) / levels, 1.0); };
  for (int level = 0;; ++level) {
    const bool last = next_count() > most;
    const Progress part = progress_within(progress, share(level), share(level + 1));
    if (level > 0) go_rounds(settled_ ? Soundness::Whole : Soundness::Unfolded, progress_within(part, 0.0, 0.5));
    finish_level(last, progress_within(part, 0.5, 1.0));
    if (last || report_.end == FitEnd::Tolerance) return;
    fitter_.refine();
    fitter_.attach();
    passed_.clear();
    judged_ = 0;
    schedule_.note_refined();
  }
}

void FitRun::settle() {
  if (const PassedSurfaces::Surface* const best = passed_.best(fitter_)) fitter_.move_to(best->control);
  fitter_.attach();
}

void FitRun::show() const {
  if (watch_) watch_({fitter_.topology(), fitter_.scheme(), fitter_.control()});
}

FitErrors FitRun::measured() const { return fit_errors(fitter_.distances(), outliers_, report_.diameter); }

bool FitRun::reached(const FitErrors& errors) {
  if (!(options_.tolerance > 0.0) || !(errors.max * report_.diameter <= options_.tolerance)) return false;
  if (has_unsound_beyond(allowed_)) return false;
  report_.end = FitEnd::Tolerance;
  return true;
}

/// Unsound faces are counted only where their number matters.
bool FitRun::has_unsound_beyond(Index most) const { return most < kAnyNumber && fitter_.unsound_faces() > most; }

/// Keeps the surface among those that were passed.
void FitRun::note_passed() { passed_.note({fitter_.control(), measured().rms}); }

/// Relaxes the surface where it is not sound, and goes on from there until it is.
void FitRun::mend() {
  constexpr int kRounds = 10;
  if (settled_) return smooth_unsound();
  for (int round = 0; round < kRounds && has_unsound_beyond(allowed_); ++round) {
    fitter_.hold_unsound();
    if (!fitter_.relax(Soundness::Unfolded)) return;
    fitter_.attach();
    go_round(Soundness::Unfolded);
    note_passed();
  }
}

/// Makes a surface sound that is near the points already: the energy of the control points around unsound faces counts
/// more from round to round, and where that does not do, these faces are evened out little by little. Both cost less
/// distance than relaxing, which draws the ends of thin parts in.
void FitRun::smooth_unsound() {
  constexpr int kRounds = 6;
  constexpr double kFirst = 40.0;  // of the fairness
  constexpr double kGrowth = 1.1;
  constexpr int kEvenRounds = 60;
  constexpr double kEvenPart = 0.2;
  if (!has_unsound_beyond(allowed_)) return;
  FitStep step = schedule_.step();
  step.mending = kFirst * step.fairness;
  for (int round = 0; round < kRounds && has_unsound_beyond(allowed_); ++round) {
    fitter_.hold_unsound();
    fitter_.move_to(fitter_.stepped(fitter_.control(), fitter_.find_step(step), Soundness::Whole));
    fitter_.attach();
    note_passed();
    step.mending *= kGrowth;
  }
  for (int round = 0; round < kEvenRounds && has_unsound_beyond(allowed_); ++round) {
    fitter_.even_out_unsound(kEvenPart);
    evened_out_ = true;
  }
  fitter_.attach();
  note_passed();
}

/// Evens the surface out where it is still not sound; false where there is nothing to do.
bool FitRun::even_out() {
  constexpr int kRounds = 20;
  constexpr double kPart = 0.5;
  if (!has_unsound_beyond(allowed_)) return false;
  evened_out_ = true;
  for (int round = 0; round < kRounds && has_unsound_beyond(allowed_); ++round) fitter_.even_out_unsound(kPart);
  fitter_.attach();
  note_passed();
  return true;
}

/// Goes back to the best surface of this control mesh; false if that is the last one.
bool FitRun::return_to_best() {
  const PassedSurfaces::Surface* const best = passed_.best(fitter_);
  if (best == nullptr || best->control == fitter_.control()) return false;
  fitter_.move_to(best->control);
  fitter_.attach();
  schedule_.note_restart(measured());
  return true;
}

Index FitRun::next_count() const { return refined_vertex_count(fitter_.topology(), fitter_.scheme().kind); }

/// What follows the first rounds of a control mesh. On the way to the points the surface may pass through itself: held
/// back from that it would often stay where it is. Rounds that start from the best whole surface then keep it so.
void FitRun::finish_level(bool last, const Progress& progress) {
  mend();
  bool again = return_to_best() && !settled_;
  if (last && even_out()) {
    schedule_.note_restart(measured());
    again = true;
  }
  if (again && last && report_.end != FitEnd::Tolerance) {
    go_rounds(Soundness::Whole, progress_within(progress, 0.0, 0.4));
    return_to_best();
  }
  if (last && report_.end == FitEnd::Budget) lower_worst(progress_within(progress, 0.4, 1.0));
}

/// Rounds number `first` to `end` of so many in a row; true where further ones would gain nothing.
bool FitRun::go_rounds(Soundness asked, int first, int end, const Progress& progress) {
  report_.end = FitEnd::Rounds;
  for (int round = first; round < end; ++round) {
    report_progress(progress, static_cast<double>(round) / options_.rounds);
    go_round(asked);
    if (asked == Soundness::Unfolded) judge();
    const FitErrors errors = measured();
    schedule_.note(errors);
    note_passed();
    if (reached(errors)) {
      passed_.clear();
      passed_.note({fitter_.control(), errors.rms, 0});
      return true;
    }
    if (!schedule_.is_stuck()) continue;
    if (!settled_ && leave_out_far()) continue;
    report_.end = FitEnd::Budget;
    return true;
  }
  return false;
}

/// Judges anew which points are far outliers, where none are lonely; true where that changes.
bool FitRun::leave_out_far() {
  if (filter_.has_lonely()) return false;
  Buffer<std::uint8_t> flags = filter_.lonely();
  filter_.add_far(fitter_.distances(), flags);
  if (judged_ == kJudgements || flags == far_) return false;
  ++judged_;
  far_ = std::move(flags);
  judge();
  passed_.clear();
  schedule_.note_restart(measured());
  return true;
}

/// Weighs each point by how surely it belongs to the surface as it is.
void FitRun::judge() {
  constexpr double kBelongs = 0.5;
  const Points& points = fitter_.cloud().points;
  Points offsets(points.rows(), 3);
  for (Eigen::Index i = 0; i < offsets.rows(); ++i)
    offsets.row(i) = points.row(i) - fitter_.attached()[static_cast<std::size_t>(i)].point.transpose();
  if (filter_.has_lonely()) far_ = filter_.lonely_and_far(fitter_.distances());
  belonging_ = filter_.belonging_to(far_, offsets);
  for (std::size_t i = 0; i < outliers_.size(); ++i)
    outliers_[i] = belonging_[static_cast<Eigen::Index>(i)] < kBelongs ? 1 : 0;
  set_weights(0.0);
}

/// Points count the more the farther away they are; of all rounds the surface with the least maximum is kept whose RMS
/// has not grown too much.
void FitRun::lower_worst(const Progress& progress) {
  // Where points are many, one alone is rarely far away, and rounds are long.
  constexpr Eigen::Index kPointsInAll = 60000;
  constexpr Eigen::Index kFewest = 2;
  constexpr Eigen::Index kMost = 24;
  const auto rounds =
      static_cast<int>(std::clamp<Eigen::Index>(kPointsInAll / fitter_.distances().size(), kFewest, kMost));
  constexpr double kExact = 1e-10;
  constexpr double kMostGrowth = 1.1;
  constexpr int kStill = 3;
  FitErrors best = measured();
  if (best.rms < kExact) return;
  const double most = kMostGrowth * best.rms;
  const Index unsound = allowed_ == kAnyNumber ? kAnyNumber : fitter_.unsound_faces();
  passed_.clear();
  passed_.note({fitter_.control(), best.rms, unsound});
  int still = 0;  // rounds in a row that moved nothing
  for (int round = 0; round < rounds && still < kStill; ++round) {
    report_progress(progress, static_cast<double>(round) / rounds);
    const Values before = fitter_.control();
    set_weights(kWorstPower);
    go_round(Soundness::Unfolded);
    still = fitter_.control() == before ? still + 1 : 0;
    const FitErrors errors = measured();
    if (!(errors.max < best.max) || errors.rms > most || has_unsound_beyond(unsound)) continue;
    best = errors;
    passed_.clear();
    passed_.note({fitter_.control(), best.rms, unsound});
    if (reached(errors)) break;
  }
  settle();
}

/// Points count as surely as they belong, and by a power of their distance; half of it is what they counted before.
void FitRun::set_weights(double power) {
  constexpr double kMost = 100.0;
  const double rms = measured().rms * report_.diameter;
  Scalars weights = fitter_.weights();
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    const double share = rms > 0.0 ? fitter_.distances()[i] / rms : 1.0;
    const double wanted = power > 0.0 ? std::min(kMost, 0.5 + 0.5 * std::pow(share, power)) : 1.0;
    weights[i] = power > 0.0 ? 0.5 * (weights[i] + belonging_[i] * wanted) : belonging_[i] * wanted;
  }
  fitter_.set_weights(std::move(weights));
}

/// Moves by a step, or by a part of it that lowers the objective.
void FitRun::go_round(Soundness asked) {
  constexpr int kHalvings = 3;
  constexpr double kGain = 0.03;
  constexpr int kFollow = 2;
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
    Values next = fitter_.stepped(before, move, asked);
    // The others follow where some are held; otherwise their step would no longer lower the objective.
    for (int again = 0; settled_ && halving == 0 && again < kFollow && fitter_.has_held(); ++again) {
      move = fitter_.find_step_beside(step, next - before);
      next = fitter_.stepped(before, move, asked);
    }
    fitter_.move_to(next);
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

}  // namespace batten
