#include "batten/dynamics/elastic_motion.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "batten/dynamics/mixed_rounds.h"
#include "batten/dynamics/step_system.h"
#include "batten/dynamics/time_forms.h"
#include "batten/error.h"
#include "batten/mesh/checked_values.h"
#include "batten/solve/sparse_product.h"

namespace batten {

namespace {

/// Rounds of an equilibrium that are mixed.
constexpr int kMixedRounds = 6;
/// advance() halves a step at most so often.
constexpr int kMostHalvings = 12;
/// Of a body that only its mass holds, while an equilibrium is looked for: its pull towards the last round, relative
/// to the stiffness.
constexpr double kInertia = 1e-3;

void require_options(const MotionOptions& options) {
  const auto refuse = [](const std::string& what) { throw Error(ErrorCode::BadArgument, what); };
  if (!(options.step > 0.0) || !std::isfinite(options.step)) refuse("a step takes a positive number of seconds");
  if (options.rounds < 1) refuse("a step takes one round or more, not " + std::to_string(options.rounds));
  if (!(options.tolerance >= 0.0)) refuse("the tolerance of a step is zero or more");
  if (!(options.solver_tolerance > 0.0)) refuse("the tolerance of the solver is positive");
}

double farthest(const Points& a, const Points& b) {
  return a.rows() == 0 ? 0.0 : std::sqrt((a - b).rowwise().squaredNorm().maxCoeff());
}

}  // namespace

struct ElasticMotion::Parts {
  ElasticSurface surface;
  std::vector<std::shared_ptr<const Force>> forces;
  Supports supports;
  MotionOptions options;
  HeldPoints held;
  std::map<double, StepSystem> systems;  ///< of each length of a step

  Parts(ElasticSurface surface_in, std::vector<std::shared_ptr<const Force>> forces_in, Supports supports_in,
        const MotionOptions& options_in)
      : surface(std::move(surface_in)),
        forces(std::move(forces_in)),
        supports(std::move(supports_in)),
        options(options_in),
        held(surface, supports) {
    require_options(options);
    for (std::size_t i = 0; i < forces.size(); ++i) {
      if (!forces[i]) throw Error(ErrorCode::BadArgument, "force " + std::to_string(i) + " is null");
    }
  }

  void require_state(const ElasticState& state) const;
  ForceSum sum_of(const ForceInput& input) const;
  const StepSystem& system(double step, const ForceSum& sum);
  std::unique_ptr<StepSystem> equilibrium_system(const ForceSum& sum, double& inertia) const;
  Points total_force(const ForceSum& sum, const Points& positions) const;
  StepReport step(double seconds, ElasticState& state, const Progress& progress);
  double advance(double seconds, int halvings, double tolerance, ElasticState& state, StepReport& report,
                 const Progress& progress);
};

void ElasticMotion::Parts::require_state(const ElasticState& state) const {
  for (const Points* values : {&state.positions, &state.velocities}) {
    if (values->rows() != surface.rest().rows()) {
      throw Error(ErrorCode::BadShape, "the state has " + std::to_string(values->rows()) +
                                           " control points, but the body has " +
                                           std::to_string(surface.rest().rows()));
    }
  }
  require_finite(state.positions, "positions");
  require_finite(state.velocities, "velocities");
}

ForceSum ElasticMotion::Parts::sum_of(const ForceInput& input) const {
  ForceSum sum;
  sum.force = Points::Zero(surface.rest().rows(), 3);
  for (const auto& force : forces) {
    const std::size_t springs = sum.springs.size();
    force->add(input, sum);
    bool finite = sum.force.allFinite() && std::isfinite(sum.energy);
    for (std::size_t i = springs; i < sum.springs.size(); ++i) {
      finite = finite && sum.springs[i].targets.allFinite() && sum.springs[i].stiffness.allFinite();
    }
    if (!finite) {
      throw Error(ErrorCode::NotFinite,
                  "the force \"" + force->name() + "\" is not finite at " + std::to_string(input.time) + " s");
    }
  }
  return sum;
}

namespace {

std::vector<PlaceSprings> lasting_springs(const ForceSum& sum) {
  std::vector<PlaceSprings> lasting;
  for (const PlaceSprings& springs : sum.springs) {
    if (springs.lasting) lasting.push_back(springs);
  }
  return lasting;
}

}  // namespace

const StepSystem& ElasticMotion::Parts::system(double step, const ForceSum& sum) {
  const auto found = systems.find(step);
  if (found != systems.end()) return found->second;
  return systems
      .try_emplace(step, surface, step_weights(options.scheme, step), lasting_springs(sum), held, options.solver,
                   options.solver_tolerance)
      .first->second;
}

/// Where neither supports nor lasting springs hold the body, its own inertia does: then `inertia` is not 0.
std::unique_ptr<StepSystem> ElasticMotion::Parts::equilibrium_system(const ForceSum& sum, double& inertia) const {
  const std::vector<PlaceSprings> lasting = lasting_springs(sum);
  const auto make = [&](double mass) {
    return std::make_unique<StepSystem>(surface, StepWeights{mass, 0.0}, lasting, held, options.solver,
                                        options.solver_tolerance);
  };
  const double mass = surface.mass().diagonal().sum();
  const double by_mass = mass > 0.0 ? kInertia * surface.stiffness().diagonal().sum() / mass : 0.0;
  inertia = 0.0;
  if (by_mass > 0.0 && supports.empty() && lasting.empty()) {
    inertia = by_mass;
    return make(inertia);
  }
  try {
    return make(inertia);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::SingularSystem || !(by_mass > 0.0)) throw;
    inertia = by_mass;
    return make(inertia);
  }
}

/// Elastic force, forces and springs at positions: zero at an equilibrium.
Points ElasticMotion::Parts::total_force(const ForceSum& sum, const Points& positions) const {
  Points total = surface.force(positions) + sum.force;
  for (const PlaceSprings& spring : sum.springs) {
    if (spring.rows->rows.rows() == 0) continue;
    Values stretch = spring.targets - spring.rows->rows * positions;
    turn_into_forces(spring, stretch);
    total += spring.rows->transposed * stretch;
  }
  return total;
}

StepReport ElasticMotion::Parts::step(double seconds, ElasticState& state, const Progress& progress) {
  require_state(state);
  const TimeScheme scheme = options.scheme;
  const double end = state.time + seconds;
  Points carried = inertia_force(scheme, seconds, surface, state);
  if (takes_start_force(scheme)) {
    const ForceSum sum = sum_of({state.time, seconds, state.positions, state.positions, state.velocities});
    carried += total_force(sum, state.positions);
  }
  const HeldPlaces places = held.at(end);
  Points positions = guess_positions(scheme, seconds, state);
  held.lead(places, positions);
  Points multipliers = Points::Zero(held.pin_count(), 3);
  StepReport report;
  Points right;
  Points rest_force(positions.rows(), 3);
  while (report.rounds < options.rounds && !report.settled) {
    report_progress(progress, static_cast<double>(report.rounds) / options.rounds);
    const Points velocities = end_velocities(scheme, seconds, state, positions);
    const ForceSum sum = sum_of({end, seconds, state.positions, positions, velocities});
    surface.rest_force(positions, rest_force);
    const Points now = carried + rest_force + sum.force;
    const bool changing = std::any_of(sum.springs.begin(), sum.springs.end(),
                                      [](const PlaceSprings& springs) { return !springs.lasting; });
    if (report.rounds > 0 && !changing && sum.along.empty() && now == right) {
      report.settled = true;  // nothing depends on the positions
      report.change = 0.0;
      break;
    }
    right = now;
    const Points before = positions;
    const StepSolve solved = system(seconds, sum).solve({right, sum, places, multipliers, progress}, positions);
    ++report.rounds;
    report.solver_iterations += solved.iterations;
    report.change = farthest(positions, before);
    if (!std::isfinite(report.change)) {
      throw Error(ErrorCode::NotFinite, "the motion has run away in the step that ends at " + std::to_string(end) +
                                            " s; take shorter steps or weaker forces");
    }
    report.settled = report.change <= options.tolerance * surface.diagonal();
  }
  report.support_error = held.error(places, positions);
  state.velocities = end_velocities(scheme, seconds, state, positions);
  state.positions = std::move(positions);
  state.time = end;
  return report;
}

/// One interval, halved until a step of its whole length and two of half of it agree. Returns the estimated error.
double ElasticMotion::Parts::advance(double seconds, int halvings, double tolerance, ElasticState& state,
                                     StepReport& report, const Progress& progress) {
  ElasticState whole = state;
  step(seconds, whole, progress);
  ElasticState halves = state;
  step(0.5 * seconds, halves, progress);
  StepReport last = step(0.5 * seconds, halves, progress);
  const double error = farthest(whole.positions, halves.positions) / (std::pow(2.0, order_of(options.scheme)) - 1.0);
  if (error <= tolerance || halvings == kMostHalvings) {
    halves.time = state.time + seconds;
    state = std::move(halves);
    last.time_error = error;
    report = last;
    return error;
  }
  advance(0.5 * seconds, halvings + 1, tolerance, state, report, progress);
  return advance(0.5 * seconds, halvings + 1, tolerance, state, report, progress);
}

ElasticMotion::ElasticMotion(const ElasticSurface& surface, std::vector<std::shared_ptr<const Force>> forces,
                             Supports supports, const MotionOptions& options)
    : parts_(std::make_unique<Parts>(surface, std::move(forces), std::move(supports), options)) {}

ElasticMotion::~ElasticMotion() = default;
ElasticMotion::ElasticMotion(ElasticMotion&&) noexcept = default;
ElasticMotion& ElasticMotion::operator=(ElasticMotion&&) noexcept = default;

const ElasticSurface& ElasticMotion::surface() const { return parts_->surface; }
const std::vector<std::shared_ptr<const Force>>& ElasticMotion::forces() const { return parts_->forces; }
const Supports& ElasticMotion::supports() const { return parts_->supports; }
const MotionOptions& ElasticMotion::options() const { return parts_->options; }

StepReport ElasticMotion::step(ElasticState& state, const Progress& progress) {
  return parts_->step(parts_->options.step, state, progress);
}

MotionMeasure ElasticMotion::measure(const ElasticState& state) const {
  const Parts& parts = *parts_;
  parts.require_state(state);
  const Points still = Points::Zero(state.positions.rows(), 3);
  const ForceSum sum = parts.sum_of({state.time, 0.0, state.positions, state.positions, still});
  MotionMeasure measure;
  measure.kinetic_energy = parts.surface.kinetic_energy(state.velocities);
  measure.elastic_energy = parts.surface.energy(state.positions);
  measure.force_energy = sum.energy;
  Points total = parts.total_force(sum, state.positions);
  if (parts.held.pin_count() > 0) total -= parts.held.reaction(total);
  for (const Index v : parts.held.free()) {
    measure.residual_force = std::max(measure.residual_force, total.row(v).norm());
  }
  return measure;
}

StepReport ElasticMotion::advance(ElasticState& state, double seconds, double tolerance, const Progress& progress) {
  Parts& parts = *parts_;
  if (!(seconds >= 0.0) || !std::isfinite(seconds) || !(tolerance > 0.0)) {
    throw Error(ErrorCode::BadArgument, "a motion advances by zero seconds or more, with a positive tolerance");
  }
  StepReport report;
  const double absolute = tolerance * parts.surface.diagonal();
  const double end = state.time + seconds;
  const auto intervals = static_cast<std::int64_t>(std::ceil(seconds / parts.options.step - 1e-9));
  for (std::int64_t i = 0; i < intervals; ++i) {
    report_progress(progress, static_cast<double>(i) / static_cast<double>(intervals));
    // Intervals of the same length have the same systems; only the last may be shorter.
    const bool last = i + 1 == intervals;
    const double left = end - state.time;
    const bool whole = !last || std::abs(left - parts.options.step) <= 1e-9 * parts.options.step;
    parts.advance(whole ? parts.options.step : left, 0, absolute, state, report, {});
    if (last) state.time = end;
  }
  return report;
}

EquilibriumReport ElasticMotion::find_equilibrium(ElasticState& state, const EquilibriumOptions& options,
                                                  const Progress& progress) {
  const Parts& parts = *parts_;
  parts.require_state(state);
  if (!(options.tolerance > 0.0) || options.rounds < 1) {
    throw Error(ErrorCode::BadArgument, "an equilibrium takes one round or more, and a positive tolerance");
  }
  const HeldPlaces places = parts.held.at(state.time);
  const Points still = Points::Zero(state.positions.rows(), 3);
  Points positions = state.positions;
  parts.held.lead(places, positions);
  Points multipliers = Points::Zero(parts.held.pin_count(), 3);
  MixedRounds mixed(kMixedRounds);
  double inertia = 0.0;
  std::unique_ptr<StepSystem> system;
  EquilibriumReport report;
  const double within = options.tolerance * parts.surface.diagonal();
  while (report.rounds < options.rounds && !report.converged) {
    report_progress(progress, static_cast<double>(report.rounds) / options.rounds);
    const ForceSum sum = parts.sum_of({state.time, 0.0, positions, positions, still});
    if (!system) system = parts.equilibrium_system(sum, inertia);
    Points right(positions.rows(), 3);
    parts.surface.rest_force(positions, right);
    right += sum.force;
    Values product;
    multiply(parts.surface.mass(), positions, product);
    right += inertia * product;
    Points after = positions;
    report.solver_iterations += system->solve({right, sum, places, multipliers, {}}, after).iterations;
    ++report.rounds;
    report.change = farthest(after, positions);
    if (!std::isfinite(report.change)) {
      throw Error(ErrorCode::NotFinite,
                  "no equilibrium: the body has run away after " + std::to_string(report.rounds) + " rounds");
    }
    report.converged = report.change <= within;
    positions = report.converged ? after : mixed.next(positions, after);
  }
  state.positions = positions;
  state.velocities = still;
  report.residual_force = measure(state).residual_force;
  return report;
}

ElasticMotion ElasticMotion::refined(const ElasticState& state, const Progress& progress) const {
  parts_->require_state(state);
  const ElasticSurface child = surface().refined(progress);
  std::vector<std::shared_ptr<const Force>> forces;
  for (const auto& force : parts_->forces) forces.push_back(force->refined(surface(), child));
  return ElasticMotion(child, std::move(forces), refined_supports(surface(), supports(), state), options());
}

}  // namespace batten
