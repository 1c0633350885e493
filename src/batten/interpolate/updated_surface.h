/// \file The state of InterpolationUpdates: targets, control points, and what local work goes by.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "batten/interpolate/component_errors.h"
#include "batten/interpolate/interpolation_system.h"
#include "batten/interpolate/interpolation_updates.h"
#include "batten/interpolate/local_relaxation.h"

namespace batten {

class UpdatedSurface {
 public:
  /// is_solved: `surface` is a solve's, to be solved a little further; otherwise it stays as it is.
  UpdatedSurface(std::shared_ptr<const InterpolationSystem> system, ConstValuesRef targets, Interpolant surface,
                 bool is_solved);

  const Values& targets() const { return targets_; }
  const Interpolant& surface() const { return surface_; }
  std::span<const Index> moved() const { return moved_; }
  double error_bound() const { return error_bound_; }
  /// True where a component is refined once, so that the control points are not the vertices'.
  bool is_refined() const { return surface_.control.rows() != targets_.rows(); }

  void set_targets(std::span<const Index> rows, ConstValuesRef values);
  /// Moves what the changed targets ask for. False where that is no local matter: then nothing has changed.
  bool update_locally(std::span<const Index> changed, UpdateReport& report);
  /// Solves for all targets. Throws what Interpolator::solve() does, and changes nothing then.
  void update_whole(UpdateReport& report, const Progress& progress);
  /// Moves what lies within the rings, and gives up the targets that are missed then. Throws what fit_locally() does,
  /// and changes nothing then.
  void update_within(int rings, std::span<const Index> changed, UpdateReport& report, const Progress& progress);

 private:
  Index label(Index vertex) const { return components_->of_vertex[vertex]; }
  double wanted_error(const ComponentErrors& component) const;
  std::vector<ComponentErrors> measure() const;
  /// Sets what local work goes by. From then on, rows that no update touches keep the errors that they have.
  void begin(bool is_solved);
  void find_singular();
  void polish(std::vector<ComponentErrors>& errors);
  bool solve_rest(double tolerance);
  void begin_update() {
    moved_.clear();
    rows_.clear();
  }
  void move(Index vertex, const double* change);
  /// The error of a vertex, and Q - A P in `miss`.
  double measure_row(Index vertex, ValueRow& miss) const;

  std::shared_ptr<const InterpolationSystem> system_;
  Values targets_;
  Interpolant surface_;
  std::shared_ptr<const Components> components_;
  Buffer<double> tolerance_;          ///< of each component, for local work
  Buffer<std::uint8_t> needs_whole_;  ///< of each component: it is singular, or all are refined
  double error_bound_ = 0.0;
  std::vector<Index> moved_;
  LocalRows rows_;
  LocalRelaxation relaxation_;
};

}  // namespace batten
