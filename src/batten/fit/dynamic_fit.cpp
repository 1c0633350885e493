#include "batten/fit/dynamic_fit.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "batten/dynamics/elastic_motion.h"
#include "batten/dynamics/nearest_springs.h"
#include "batten/error.h"
#include "batten/fit/fit_errors.h"
#include "batten/fit/fit_levels.h"
#include "batten/progress.h"
#include "batten/refine/refined_values.h"
#include "batten/solve/solver.h"

namespace batten {

namespace {

/// What resists beside springs whose stiffness is 1 in all. With faces as unit squares these have no unit: a sphere
/// stays by some 25 tensions below its radius. Half of it folds a scanned head.
constexpr double kBodyTension = 6e-5;
constexpr double kBodyRigidity = 1e-6;
/// Damping is 1 in all, too: so long takes the body as a whole to come near by a factor e.
constexpr double kStepSeconds = 1.0;
constexpr int kStepsOfRound = 10;
/// Forces balance where a round takes less than this off the energy.
constexpr double kLeastGain = 0.005;

ElasticOptions paper_body(const Topology& topology) {
  ElasticOptions options;
  options.material = {{0.0}, {1.0 / std::max<Index>(topology.face_count(), 1)}, {kBodyTension}, {kBodyRigidity}};
  options.rest = RestModel::Point;
  options.measure = ElasticMeasure::Parameters;
  return options;
}

MotionOptions without_mass() {
  MotionOptions options;
  options.scheme = TimeScheme::MassFree;
  options.step = kStepSeconds;
  options.rounds = 1;
  options.solver_tolerance = 1e-4;
  return options;
}

/// The body, its springs and where it is.
class SpringFit {
 public:
  SpringFit(const Mesh& start, const Points& points, const Buffer<std::uint8_t>& outliers, const FitOptions& options,
            double diameter, FitReport& report)
      : options_(options),
        outliers_(outliers),
        diameter_(diameter),
        report_(report),
        scheme_(options.scheme),
        motion_(motion_of(start, points)),
        state_(state_at_rest(motion_.surface())) {}

  void go(const Progress& progress) {
    show();
    const Index most = most_fit_vertices(options_);
    const int levels = fit_level_count(motion_.surface().topology(), scheme_.kind, most);
    for (int level = 0;; ++level) {
      const double begin = std::min(static_cast<double>(level) / levels, 1.0);
      find_balance(progress_within(progress, begin, std::min(begin + 1.0 / levels, 1.0)));
      if (report_.end == FitEnd::Tolerance || next_count() > most) return;
      refine();
    }
  }

  DynamicFit result() const { return {motion_.surface().topology(), scheme_, whole_}; }
  void show() const {
    if (options_.watch) options_.watch({motion_.surface().topology(), scheme_, state_.positions});
  }

 private:
  /// Only the points that are followed have springs that draw.
  ElasticMotion motion_of(const Mesh& start, const Points& points) {
    const Topology topology(start);
    const ElasticSurface body(topology, scheme_, start.points, paper_body(topology));
    const auto followed = static_cast<double>(std::count(outliers_.begin(), outliers_.end(), std::uint8_t{0}));
    NearestSpringOptions springs;
    springs.stiffness.clear();
    for (const std::uint8_t outlier : outliers_) springs.stiffness.push_back(outlier != 0 ? 0.0 : 1.0 / followed);
    springs_ = std::make_shared<const NearestSprings>(body, points, std::move(springs));
    whole_ = start.points;
    return {body, {springs_}, {}, without_mass()};
  }

  Index next_count() const { return refined_vertex_count(motion_.surface().topology(), scheme_.kind); }

  void refine() {
    ElasticMotion finer = motion_.refined(state_);
    state_ = refined_state(motion_.surface(), state_);
    motion_ = std::move(finer);
    springs_ = std::dynamic_pointer_cast<const NearestSprings>(motion_.forces().front());
    scheme_ = scheme_.after_first_step();
    whole_ = state_.positions;
  }

  /// Twice the energy: that of the springs alone is the mean squared distance.
  double objective() const {
    const MotionMeasure measure = motion_.measure(state_);
    return 2.0 * (measure.elastic_energy + measure.force_energy);
  }

  void find_balance(const Progress& progress) {
    report_.end = FitEnd::Rounds;
    for (int round = 0; round < options_.rounds; ++round) {
      go_round(progress_within(progress, static_cast<double>(round) / options_.rounds,
                               static_cast<double>(round + 1) / options_.rounds));
      const FitRound& last = report_.rounds.back();
      if (options_.tolerance > 0.0 && last.max <= options_.tolerance) {
        report_.end = FitEnd::Tolerance;
        return;
      }
      if (last.objective - last.after < kLeastGain * last.objective) {
        report_.end = FitEnd::Budget;
        return;
      }
    }
  }

  void go_round(const Progress& progress) {
    const Stopwatch watch;
    FitRound round;
    round.objective = objective();
    for (int step = 0; step < kStepsOfRound; ++step) {
      const Progress part = progress_within(progress, static_cast<double>(step) / kStepsOfRound,
                                            static_cast<double>(step + 1) / kStepsOfRound);
      report_progress(part, 0.0);
      round.iterations += motion_.step(state_, part).solver_iterations;
    }
    round.after = objective();
    const std::vector<NearestPoint>& attached = springs_->attach(state_.positions);
    Scalars distances(static_cast<Eigen::Index>(attached.size()));
    for (std::size_t i = 0; i < attached.size(); ++i) distances[static_cast<Eigen::Index>(i)] = attached[i].distance;
    const FitErrors errors = fit_errors(distances, outliers_, diameter_);
    round.vertices = static_cast<Index>(state_.positions.rows());
    round.fairness = kBodyRigidity;
    round.max = errors.max * diameter_;
    round.rms = errors.rms * diameter_;
    round.seconds = watch.seconds();
    report_.rounds.push_back(round);
    whole_ = state_.positions;
    show();
  }

  const FitOptions& options_;
  const Buffer<std::uint8_t>& outliers_;
  double diameter_;
  FitReport& report_;
  Scheme scheme_;
  std::shared_ptr<const NearestSprings> springs_;
  Points whole_;  ///< after the last whole round
  ElasticMotion motion_;
  ElasticState state_;
};

}  // namespace

DynamicFit fit_dynamic(const Mesh& start, const Points& points, const Buffer<std::uint8_t>& outliers,
                       const FitOptions& options, double diameter, FitReport& report, const Progress& progress) {
  SpringFit fit(start, points, outliers, options, diameter, report);
  try {
    fit.go(progress);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::Cancelled || report.rounds.empty()) throw;
    report.end = FitEnd::Cancelled;
  }
  return fit.result();
}

}  // namespace batten
