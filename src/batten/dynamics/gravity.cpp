#include "batten/dynamics/gravity.h"

#include "batten/dynamics/force_checks.h"

namespace batten {

Gravity::Gravity(const ElasticSurface& body, const Eigen::Vector3d& acceleration)
    : acceleration_(acceleration), masses_(body.mass() * Scalars::Ones(body.mass().cols())) {
  require_finite_vector(acceleration, "the acceleration of gravity");
}

void Gravity::add(const ForceInput& input, ForceSum& sum) const {
  sum.force.noalias() += masses_ * acceleration_.transpose();
  sum.energy -= masses_.dot(input.positions * acceleration_);
}

std::shared_ptr<const Force> Gravity::refined(const ElasticSurface& /*body*/, const ElasticSurface& child) const {
  return std::make_shared<Gravity>(child, acceleration_);
}

}  // namespace batten
