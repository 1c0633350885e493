/// \file One set of values on its way from targets to control points.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "batten/interpolate/component_errors.h"
#include "batten/interpolate/interpolation_system.h"
#include "batten/interpolate/measured_error.h"

namespace batten {

/// Rounding of the targets themselves is the floor of what a solver can be asked for, relative to the largest.
inline constexpr double kSolverFloor = 1e-15;

struct ValueSet {
  /// `given` must outlive it. Throws Error: BadShape, NotFinite (names the vertex).
  ValueSet(const InterpolationSystem& system, const Targets& given_in, const Progress& progress);

  ConstValuesRef targets() const { return given->values; }
  bool has_least_squares() const;
  /// For when x has changed.
  void forget_errors() {
    measured.reset();
    judged.clear();
  }
  /// Throws Error(SingularSystem): the component of `vertex`, of `count` vertices, has no surface for these targets.
  [[noreturn]] void refuse(Index vertex, std::size_t count, const std::string& reason) const;

  const Targets* given;
  double diagonal = 0.0;
  StopRule stop;
  Values x;
  Values aims;  ///< what least squares can reach instead of the targets; empty: the targets
  SolveReport report;
  std::vector<SingularReport> singular;
  std::optional<MeasuredErrors> measured;  ///< of the present x
  std::vector<ComponentErrors> judged;     ///< likewise, against the aims; empty: not yet
};

}  // namespace batten
