#include "batten/interpolate/updated_surface.h"

#include <algorithm>
#include <limits>

#include "batten/interpolate/joint_solve.h"
#include "batten/interpolate/local_fit.h"
#include "batten/interpolate/measured_error.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// Control points differ from those of an exact solve by up to some 13 times what limit positions do.
constexpr double kShareOfTolerance = 1.0 / 16.0;
/// Rounding of what a row sums up, relative to the farthest control point.
constexpr double kRowRounding = 8.0 * std::numeric_limits<double>::epsilon();
/// Beyond so many rows looked at, solving everything is faster: a whole solve costs about as much as looking at 6 V.
constexpr std::int64_t kMostSteps = 100'000;
constexpr std::int64_t kMostStepsPerVertex = 4;
/// Likewise for changed targets.
constexpr Index kLeastVerticesPerTarget = 8;

}  // namespace

UpdatedSurface::UpdatedSurface(std::shared_ptr<const InterpolationSystem> system, ConstValuesRef targets,
                               Interpolant surface, bool is_solved)
    : system_(std::move(system)),
      targets_(targets),
      surface_(std::move(surface)),
      components_(system_->components()),
      rows_(system_->matrix()) {
  begin(is_solved);
}

std::vector<ComponentErrors> UpdatedSurface::measure() const {
  return component_errors(*components_, row_errors(system_->matrix(), surface_.control, targets_), surface_.control,
                          targets_);
}

double UpdatedSurface::wanted_error(const ComponentErrors& component) const {
  return std::max(kShareOfTolerance * system_->options().tolerance * component.diagonal,
                  kRowRounding * component.farthest);
}

/// Solves for what the solve has left, which is linear too. False where that fails.
bool UpdatedSurface::solve_rest(double tolerance) {
  Values rest(targets_.rows(), targets_.cols());
  parallel_for(targets_.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      row_residual(system_->matrix(), v, targets_, surface_.control, rest.data() + v * rest.cols());
    }
  });
  Values correction;
  if (!system_->solve(rest, correction, {tolerance, system_->options().max_iterations, {}}).converged) return false;
  for (const SingularComponent& component : system_->singular()) {
    for (const Index v : component.vertices) correction.row(v).setZero();
  }
  surface_.control += correction;
  return true;
}

/// Components within the tolerance are brought within the smaller one of updates; others have been tried already.
void UpdatedSurface::polish(std::vector<ComponentErrors>& errors) {
  double least = std::numeric_limits<double>::infinity();
  for (const ComponentErrors& one : errors) {
    if (one.error > wanted_error(one) && one.is_reached(system_->options().tolerance)) {
      least = std::min(least, wanted_error(one));
    }
  }
  if (least == std::numeric_limits<double>::infinity()) return;
  const Values before = surface_.control;
  if (!solve_rest(least)) return;
  const std::vector<ComponentErrors> after = measure();
  for (Index v = 0; v < before.rows(); ++v) {
    if (!(after[label(v)].error <= errors[label(v)].error)) surface_.control.row(v) = before.row(v);
  }
  for (std::size_t c = 0; c < errors.size(); ++c) {
    if (after[c].error <= errors[c].error) errors[c] = after[c];
  }
}

void UpdatedSurface::begin(bool is_solved) {
  error_bound_ = surface_.report.max_error;
  needs_whole_.assign(static_cast<std::size_t>(components_->count), is_refined() ? 1 : 0);
  if (is_refined()) return;
  find_singular();
  std::vector<ComponentErrors> errors = measure();
  if (is_solved) polish(errors);
  tolerance_.clear();
  error_bound_ = 0.0;
  for (const ComponentErrors& one : errors) {
    tolerance_.push_back(std::max(wanted_error(one), one.error));
    error_bound_ = std::max(error_bound_, one.error);
  }
}

void UpdatedSurface::find_singular() {
  for (const SingularComponent& one : system_->singular()) needs_whole_[label(one.vertices.front())] = 1;
  for (const SingularReport& one : surface_.report.singular) needs_whole_[label(one.vertex)] = 1;
}

void UpdatedSurface::set_targets(std::span<const Index> rows, ConstValuesRef values) {
  for (std::size_t i = 0; i < rows.size(); ++i) targets_.row(rows[i]) = values.row(static_cast<Eigen::Index>(i));
}

void UpdatedSurface::move(Index vertex, const double* change) {
  double* point = surface_.control.data() + vertex * surface_.control.cols();
  for (Eigen::Index c = 0; c < surface_.control.cols(); ++c) point[c] += change[c];
  moved_.push_back(vertex);
}

double UpdatedSurface::measure_row(Index vertex, ValueRow& miss) const {
  row_residual(system_->matrix(), vertex, targets_, surface_.control, miss.data());
  return miss.norm();
}

bool UpdatedSurface::update_locally(std::span<const Index> changed, UpdateReport& report) {
  begin_update();
  const auto count = static_cast<Index>(targets_.rows());
  if (static_cast<Index>(changed.size()) > 1 + count / kLeastVerticesPerTarget) return false;
  if (std::any_of(changed.begin(), changed.end(), [&](Index v) { return needs_whole_[label(v)] != 0; })) return false;
  const LocalSystem local{targets_, surface_.control, components_->of_vertex, tolerance_};
  const bool solved =
      relaxation_.solve(rows_, changed, local, std::max(kMostSteps, kMostStepsPerVertex * std::int64_t{count}));
  report.steps = relaxation_.steps();
  if (!solved) return false;
  for (Index place = 0; place < rows_.size(); ++place) {
    if (relaxation_.is_changed(place)) move(rows_.vertex(place), relaxation_.change(place));
  }
  ValueRow miss(targets_.cols());
  for (Index place = 0; place < rows_.size(); ++place) {
    if (rows_.has_row(place)) report.max_error = std::max(report.max_error, measure_row(rows_.vertex(place), miss));
  }
  error_bound_ = std::max(error_bound_, report.max_error);
  return true;
}

void UpdatedSurface::update_whole(UpdateReport& report, const Progress& progress) {
  const Targets all{"targets", targets_};
  surface_ = std::move(solve_jointly(*system_, {&all, 1}, progress).front());
  begin(true);
  report.is_local = false;
  report.outcome = surface_.report.outcome;
  report.max_error = error_bound_;
  moved_.resize(static_cast<std::size_t>(surface_.control.rows()));
  for (std::size_t v = 0; v < moved_.size(); ++v) moved_[v] = static_cast<Index>(v);
}

void UpdatedSurface::update_within(int rings, std::span<const Index> changed, UpdateReport& report,
                                   const Progress& progress) {
  begin_update();
  const LocalFit fit =
      fit_locally(rows_, places_within(rows_, changed, rings), changed.size(), targets_, surface_.control, progress);
  report.steps = static_cast<std::int64_t>(fit.affected.size());
  for (std::size_t i = 0; i < fit.places.size(); ++i) {
    move(rows_.vertex(fit.places[i]), fit.change.data() + i * static_cast<std::size_t>(targets_.cols()));
  }
  ValueRow miss(targets_.cols());
  for (std::size_t i = 0; i < fit.affected.size(); ++i) {
    const Index v = rows_.vertex(fit.affected[i]);
    const double error = measure_row(v, miss);
    if (i < changed.size()) {
      report.max_error = std::max(report.max_error, error);
      continue;
    }
    if (error > report.max_miss) {
      report.max_miss = error;
      report.worst_miss = v;
    }
    if (error <= tolerance_[label(v)]) continue;
    ++report.missed;
    targets_.row(v) -= miss;
  }
  error_bound_ = std::max(error_bound_, report.max_error);
}

}  // namespace batten
