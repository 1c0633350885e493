#include "batten/interpolate/interpolator.h"

#include "batten/interpolate/interpolation_system.h"
#include "batten/interpolate/joint_solve.h"

namespace batten {

Interpolator::Interpolator(const Topology& topology, const Scheme& scheme, const InterpolateOptions& options,
                           const Progress& progress)
    : system_(std::make_shared<const InterpolationSystem>(topology, scheme, options, progress)) {}

Interpolator::~Interpolator() = default;
Interpolator::Interpolator(Interpolator&&) noexcept = default;

const Topology& Interpolator::topology() const { return system_->topology(); }
const Scheme& Interpolator::scheme() const { return system_->scheme(); }
const LimitMatrix& Interpolator::limit_matrix() const { return system_->matrix(); }

Interpolant Interpolator::solve(ConstValuesRef targets, const Progress& progress) const {
  const Targets one{"targets", targets};
  return std::move(solve_jointly(*system_, {&one, 1}, progress).front());
}

std::vector<Interpolant> Interpolator::solve_together(std::span<const Targets> sets, const Progress& progress) const {
  return solve_jointly(*system_, sets, progress);
}

}  // namespace batten
