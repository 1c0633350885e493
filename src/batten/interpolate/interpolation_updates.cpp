#include "batten/interpolate/interpolation_updates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "batten/error.h"
#include "batten/interpolate/component_errors.h"
#include "batten/interpolate/interpolation_system.h"
#include "batten/interpolate/joint_solve.h"
#include "batten/interpolate/local_fit.h"
#include "batten/interpolate/local_relaxation.h"
#include "batten/interpolate/measured_error.h"
#include "batten/mesh/checked_values.h"
#include "batten/parallel/parallel.h"
#include "batten/progress.h"

namespace batten {

namespace {

/// Control points differ from those of an exact solve by up to some 13 times what limit positions do.
constexpr double kShareOfTolerance = 1.0 / 16.0;
/// Rounding of what a row sums up, relative to the farthest control point.
constexpr double kRounding = 8.0 * std::numeric_limits<double>::epsilon();
/// Beyond so many rows looked at, solving everything is faster: a whole solve costs about as much as looking at 6 V
/// rows.
constexpr std::int64_t kMostSteps = 100'000;
constexpr std::int64_t kMostStepsPerVertex = 4;
/// Likewise for changed targets.
constexpr Index kLeastVerticesPerTarget = 8;

/// Throws Error: IndexOutOfRange, BadArgument, BadShape, NotFinite.
void check_rows(std::span<const Index> rows, ConstValuesRef values, ConstValuesRef targets) {
  if (values.rows() != static_cast<Eigen::Index>(rows.size()) || values.cols() != targets.cols()) {
    throw Error(ErrorCode::BadShape, "an update needs a row of " + std::to_string(targets.cols()) +
                                         " numbers for each of its " + std::to_string(rows.size()) + " targets, not " +
                                         std::to_string(values.rows()) + "-by-" + std::to_string(values.cols()));
  }
  Buffer<Index> sorted(rows.begin(), rows.end());
  std::sort(sorted.begin(), sorted.end());
  if (!sorted.empty() && (sorted.front() < 0 || sorted.back() >= targets.rows())) {
    throw Error(ErrorCode::IndexOutOfRange,
                "no target " + std::to_string(sorted.front() < 0 ? sorted.front() : sorted.back()) +
                    ": targets are numbered from 0 to " + std::to_string(targets.rows() - 1));
  }
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end()) {
    throw Error(ErrorCode::BadArgument, "target " + std::to_string(*twice) + " is changed twice in one update");
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (values.row(static_cast<Eigen::Index>(i)).allFinite()) continue;
    throw Error(ErrorCode::NotFinite, "the new target of vertex " + std::to_string(rows[i]) + " is no finite number");
  }
}

}  // namespace

struct InterpolationUpdates::State {
  State(std::shared_ptr<const InterpolationSystem> system_in, ConstValuesRef targets_in, Interpolant surface_in)
      : system(std::move(system_in)),
        targets(targets_in),
        surface(std::move(surface_in)),
        components(system->components()),
        rows(system->matrix()) {}

  bool is_refined() const { return surface.control.rows() != targets.rows(); }
  Index label(Index vertex) const { return components->of_vertex[vertex]; }

  void begin(bool polishes);
  std::vector<ComponentErrors> measure() const;
  void polish(double least_tolerance);
  void find_singular();

  void put(std::span<const Index> changed, ConstValuesRef values);
  bool update_locally(std::span<const Index> changed, UpdateReport& report);
  void update_whole(UpdateReport& report, const Progress& progress);
  void fit(std::vector<Index> places, std::size_t exact, UpdateReport& report, const Progress& progress);
  void add(Index vertex, const double* change);

  std::shared_ptr<const InterpolationSystem> system;
  Values targets;
  Interpolant surface;
  std::shared_ptr<const Components> components;
  Buffer<double> tolerance;          ///< of each component, for local work
  Buffer<std::uint8_t> needs_whole;  ///< of each component: it is singular
  double error_bound = 0.0;
  std::vector<Index> moved;
  LocalRows rows;
  LocalRelaxation relaxation;
};

std::vector<ComponentErrors> InterpolationUpdates::State::measure() const {
  return component_errors(*components, row_errors(system->matrix(), surface.control, targets), surface.control,
                          targets);
}

/// Solves for what the solve has left, which is linear too.
void InterpolationUpdates::State::polish(double least_tolerance) {
  Values left(targets.rows(), targets.cols());
  parallel_for(targets.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      row_residual(system->matrix(), v, targets, surface.control, left.data() + v * left.cols());
    }
  });
  Values correction;
  if (!system->solve(left, correction, {least_tolerance, system->options().max_iterations, {}}).converged) return;
  for (const SingularComponent& component : system->singular()) {
    for (const Index v : component.vertices) correction.row(v).setZero();
  }
  surface.control += correction;
}

/// Sets what local work goes by. From then on, rows that no update touches keep the errors that they have.
void InterpolationUpdates::State::begin(bool polishes) {
  error_bound = surface.report.max_error;
  needs_whole.assign(static_cast<std::size_t>(components->count), is_refined() ? 1 : 0);
  if (is_refined()) return;
  find_singular();
  std::vector<ComponentErrors> errors = measure();
  const auto wanted = [&](const ComponentErrors& one) {
    return std::max(kShareOfTolerance * system->options().tolerance * one.diagonal, kRounding * one.farthest);
  };
  double least = std::numeric_limits<double>::infinity();
  for (const ComponentErrors& one : errors) {
    if (one.error > wanted(one) && one.is_reached(system->options().tolerance)) least = std::min(least, wanted(one));
  }
  if (polishes && std::isfinite(least)) {
    Values before = surface.control;
    polish(least);
    const std::vector<ComponentErrors> after = measure();
    for (Index v = 0; v < before.rows(); ++v) {
      if (!(after[label(v)].error <= errors[label(v)].error)) surface.control.row(v) = before.row(v);
    }
    for (std::size_t c = 0; c < errors.size(); ++c) {
      if (after[c].error <= errors[c].error) errors[c] = after[c];
    }
  }
  tolerance.clear();
  error_bound = 0.0;
  for (const ComponentErrors& one : errors) {
    tolerance.push_back(std::max(wanted(one), one.error));
    error_bound = std::max(error_bound, one.error);
  }
}

void InterpolationUpdates::State::find_singular() {
  for (const SingularComponent& one : system->singular()) needs_whole[label(one.vertices.front())] = 1;
  for (const SingularReport& one : surface.report.singular) needs_whole[label(one.vertex)] = 1;
}

void InterpolationUpdates::State::put(std::span<const Index> changed, ConstValuesRef values) {
  for (std::size_t i = 0; i < changed.size(); ++i) targets.row(changed[i]) = values.row(static_cast<Eigen::Index>(i));
}

void InterpolationUpdates::State::add(Index vertex, const double* change) {
  double* point = surface.control.data() + vertex * surface.control.cols();
  for (Eigen::Index c = 0; c < surface.control.cols(); ++c) point[c] += change[c];
  moved.push_back(vertex);
}

bool InterpolationUpdates::State::update_locally(std::span<const Index> changed, UpdateReport& report) {
  const auto count = static_cast<Index>(targets.rows());
  if (static_cast<Index>(changed.size()) > 1 + count / kLeastVerticesPerTarget) return false;
  if (std::any_of(changed.begin(), changed.end(), [&](Index v) { return needs_whole[label(v)] != 0; })) return false;
  const LocalSystem local{targets, surface.control, components->of_vertex, tolerance};
  const bool solved =
      relaxation.solve(rows, changed, local, std::max(kMostSteps, kMostStepsPerVertex * std::int64_t{count}));
  report.steps = relaxation.steps();
  if (!solved) return false;
  for (Index place = 0; place < rows.size(); ++place) {
    if (relaxation.is_changed(place)) add(rows.vertex(place), relaxation.change(place));
  }
  ValueRow miss(targets.cols());
  for (Index place = 0; place < rows.size(); ++place) {
    if (!rows.has_row(place)) continue;
    row_residual(system->matrix(), rows.vertex(place), targets, surface.control, miss.data());
    report.max_error = std::max(report.max_error, miss.norm());
  }
  error_bound = std::max(error_bound, report.max_error);
  return true;
}

void InterpolationUpdates::State::update_whole(UpdateReport& report, const Progress& progress) {
  const Targets all{"targets", targets};
  Interpolant solved = std::move(solve_jointly(*system, {&all, 1}, progress).front());
  surface = std::move(solved);
  report.is_local = false;
  report.outcome = surface.report.outcome;
  begin(true);
  report.max_error = error_bound;
  moved.resize(static_cast<std::size_t>(surface.control.rows()));
  for (std::size_t v = 0; v < moved.size(); ++v) moved[v] = static_cast<Index>(v);
}

void InterpolationUpdates::State::fit(std::vector<Index> places, std::size_t exact, UpdateReport& report,
                                      const Progress& progress) {
  const LocalFit fitted = fit_locally(rows, std::move(places), exact, targets, surface.control, progress);
  report.steps = static_cast<std::int64_t>(fitted.affected.size());
  for (std::size_t i = 0; i < fitted.places.size(); ++i) {
    add(rows.vertex(fitted.places[i]), fitted.change.data() + i * static_cast<std::size_t>(targets.cols()));
  }
  ValueRow miss(targets.cols());
  for (std::size_t i = 0; i < fitted.affected.size(); ++i) {
    const Index v = rows.vertex(fitted.affected[i]);
    row_residual(system->matrix(), v, targets, surface.control, miss.data());
    const double error = miss.norm();
    if (i < exact) {
      report.max_error = std::max(report.max_error, error);
      continue;
    }
    if (error > report.max_miss) {
      report.max_miss = error;
      report.worst_miss = v;
    }
    if (error <= tolerance[label(v)]) continue;
    ++report.missed;
    targets.row(v) -= miss;
  }
  error_bound = std::max(error_bound, report.max_error);
}

namespace {

/// Puts targets back unless all went well.
class Restored {
 public:
  Restored(Values& targets, std::span<const Index> rows) : targets_(targets), rows_(rows) {
    before_.resize(static_cast<Eigen::Index>(rows.size()), targets.cols());
    for (std::size_t i = 0; i < rows.size(); ++i) before_.row(static_cast<Eigen::Index>(i)) = targets.row(rows[i]);
  }
  ~Restored() {
    if (done_) return;
    for (std::size_t i = 0; i < rows_.size(); ++i) targets_.row(rows_[i]) = before_.row(static_cast<Eigen::Index>(i));
  }
  Restored(const Restored&) = delete;
  Restored& operator=(const Restored&) = delete;
  void keep_new() { done_ = true; }

 private:
  Values& targets_;
  std::span<const Index> rows_;
  Values before_;
  bool done_ = false;
};

}  // namespace

InterpolationUpdates::InterpolationUpdates(std::unique_ptr<State> state) : state_(std::move(state)) {}
InterpolationUpdates::~InterpolationUpdates() = default;
InterpolationUpdates::InterpolationUpdates(InterpolationUpdates&&) noexcept = default;

InterpolationUpdates::InterpolationUpdates(const Interpolator& interpolator, ConstValuesRef targets,
                                           const Progress& progress)
    : state_(std::make_unique<State>(interpolator.system_, targets,
                                     interpolator.solve(targets, progress_within(progress, 0.0, 0.9)))) {
  state_->begin(true);
}

InterpolationUpdates InterpolationUpdates::from_control(const Interpolator& interpolator, ConstValuesRef control) {
  Interpolant surface{interpolator.topology(), interpolator.scheme(), control, {}};
  auto state =
      std::make_unique<State>(interpolator.system_, interpolator.limit_matrix().apply(control), std::move(surface));
  state->begin(false);
  return InterpolationUpdates(std::move(state));
}

UpdateReport InterpolationUpdates::update(std::span<const Index> rows, ConstValuesRef values,
                                          const Progress& progress) {
  State& state = *state_;
  check_rows(rows, values, state.targets);
  Restored restored(state.targets, rows);
  state.put(rows, values);
  state.moved.clear();
  state.rows.clear();
  UpdateReport report;
  if (!state.update_locally(rows, report)) state.update_whole(report, progress);
  restored.keep_new();
  report.moved = static_cast<Index>(state.moved.size());
  report.error_bound = state.error_bound;
  return report;
}

UpdateReport InterpolationUpdates::update_within(int rings, std::span<const Index> rows, ConstValuesRef values,
                                                 const Progress& progress) {
  State& state = *state_;
  check_rows(rows, values, state.targets);
  if (rings < 0) throw Error(ErrorCode::BadArgument, "the number of rings must not be negative");
  if (state.is_refined()) {
    throw Error(ErrorCode::SingularSystem,
                "a component is refined once, since no surface passes through its targets otherwise: its control "
                "points are not the vertices', so a change cannot be kept within rings of these");
  }
  UpdateReport report;
  report.error_bound = state.error_bound;
  state.moved.clear();
  if (rows.empty()) return report;
  Restored restored(state.targets, rows);
  state.put(rows, values);
  state.rows.clear();
  state.fit(places_within(state.rows, rows, rings), rows.size(), report, progress);
  restored.keep_new();
  report.moved = static_cast<Index>(state.moved.size());
  report.error_bound = state.error_bound;
  return report;
}

const Values& InterpolationUpdates::targets() const { return state_->targets; }
const Values& InterpolationUpdates::control() const { return state_->surface.control; }
const Topology& InterpolationUpdates::topology() const { return state_->surface.topology; }
const Scheme& InterpolationUpdates::scheme() const { return state_->surface.scheme; }
std::span<const Index> InterpolationUpdates::moved() const { return state_->moved; }

}  // namespace batten
