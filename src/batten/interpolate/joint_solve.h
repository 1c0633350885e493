/// \file One call of Interpolator::solve_together.
#pragma once
#include "batten/interpolate/interpolation_system.h"

namespace batten {

/// See Interpolator::solve_together.
std::vector<Interpolant> solve_jointly(const InterpolationSystem& system, std::span<const Targets> sets,
                                       const Progress& progress);

}  // namespace batten
