#include "batten/interpolate/interpolation_updates.h"

#include <algorithm>
#include <string>

#include "batten/error.h"
#include "batten/interpolate/updated_surface.h"
#include "batten/progress.h"

namespace batten {

namespace {

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

/// Sets targets, and puts the old ones back unless the new ones are kept.
class TargetChange {
 public:
  TargetChange(UpdatedSurface& surface, std::span<const Index> rows, ConstValuesRef values)
      : surface_(surface), rows_(rows), before_(values.rows(), values.cols()) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      before_.row(static_cast<Eigen::Index>(i)) = surface.targets().row(rows[i]);
    }
    surface.set_targets(rows, values);
  }
  ~TargetChange() {
    if (!kept_) surface_.set_targets(rows_, before_);
  }
  TargetChange(const TargetChange&) = delete;
  TargetChange& operator=(const TargetChange&) = delete;
  void keep() { kept_ = true; }

 private:
  UpdatedSurface& surface_;
  std::span<const Index> rows_;
  Values before_;
  bool kept_ = false;
};

UpdateReport finished(const UpdatedSurface& surface, UpdateReport report) {
  report.moved = static_cast<Index>(surface.moved().size());
  report.error_bound = surface.error_bound();
  return report;
}

}  // namespace

InterpolationUpdates::InterpolationUpdates(std::unique_ptr<UpdatedSurface> state) : state_(std::move(state)) {}
InterpolationUpdates::~InterpolationUpdates() = default;
InterpolationUpdates::InterpolationUpdates(InterpolationUpdates&&) noexcept = default;

InterpolationUpdates::InterpolationUpdates(const Interpolator& interpolator, ConstValuesRef targets,
                                           const Progress& progress)
    : state_(std::make_unique<UpdatedSurface>(
          interpolator.system_, targets, interpolator.solve(targets, progress_within(progress, 0.0, 0.9)), true)) {}

InterpolationUpdates InterpolationUpdates::from_control(const Interpolator& interpolator, ConstValuesRef control) {
  const Values targets = interpolator.limit_matrix().apply(control);
  Interpolant surface{interpolator.topology(), interpolator.scheme(), control, {}};
  return InterpolationUpdates(
      std::make_unique<UpdatedSurface>(interpolator.system_, targets, std::move(surface), false));
}

UpdateReport InterpolationUpdates::update(std::span<const Index> rows, ConstValuesRef values,
                                          const Progress& progress) {
  check_rows(rows, values, targets());
  TargetChange change(*state_, rows, values);
  UpdateReport report;
  if (!state_->update_locally(rows, report)) state_->update_whole(report, progress);
  change.keep();
  return finished(*state_, report);
}

UpdateReport InterpolationUpdates::update_within(int rings, std::span<const Index> rows, ConstValuesRef values,
                                                 const Progress& progress) {
  check_rows(rows, values, targets());
  if (rings < 0) throw Error(ErrorCode::BadArgument, "the number of rings must not be negative");
  if (state_->is_refined()) {
    throw Error(ErrorCode::SingularSystem,
                "a component is refined once, since no surface passes through its targets otherwise: its control "
                "points are not the vertices', so a change cannot be kept within rings of these");
  }
  TargetChange change(*state_, rows, values);
  UpdateReport report;
  state_->update_within(rings, rows, report, progress);
  change.keep();
  return finished(*state_, report);
}

const Values& InterpolationUpdates::targets() const { return state_->targets(); }
const Values& InterpolationUpdates::control() const { return state_->surface().control; }
const Topology& InterpolationUpdates::topology() const { return state_->surface().topology; }
const Scheme& InterpolationUpdates::scheme() const { return state_->surface().scheme; }
std::span<const Index> InterpolationUpdates::moved() const { return state_->moved(); }

}  // namespace batten
