#include "batten/dynamics/time_forms.h"

#include <optional>

#include "batten/solve/sparse_product.h"

namespace batten {

StepWeights step_weights(TimeScheme scheme, double step) {
  switch (scheme) {
    case TimeScheme::BackwardEuler:
      return {1.0 / (step * step), 1.0 / step};
    case TimeScheme::SecondOrder:
      return {4.0 / (step * step), 2.0 / step};
    case TimeScheme::MassFree:
      return {0.0, 1.0 / step};
    case TimeScheme::Paper:
      return {1.0 / (step * step), 0.5 / step};
    case TimeScheme::PaperMassFree:
      return {0.0, 0.5 / step};
  }
  return {};
}

Points inertia_force(TimeScheme scheme, double step, const ElasticSurface& surface, const ElasticState& start) {
  const StepWeights weights = step_weights(scheme, step);
  // The paper's formulas look back to the position before the step's begin.
  const bool looks_back = scheme == TimeScheme::Paper || scheme == TimeScheme::PaperMassFree;
  const Points ahead = start.positions + step * start.velocities;
  const Points damped = looks_back ? Points(start.positions - step * start.velocities) : start.positions;
  Values force = Values::Zero(start.positions.rows(), 3);
  Values product;
  if (weights.mass > 0.0) {
    multiply(surface.mass(), ahead, product);
    force += weights.mass * product;
  }
  const std::optional<double> ratio = surface.damping_ratio();
  if (ratio == 0.0) return force;
  multiply(ratio ? surface.mass() : surface.damping(), damped, product);
  force += weights.damping * ratio.value_or(1.0) * product;
  return force;
}

Points guess_positions(TimeScheme scheme, double step, const ElasticState& start) {
  if (step_weights(scheme, step).mass > 0.0) return start.positions + step * start.velocities;
  return start.positions;
}

Points end_velocities(TimeScheme scheme, double step, const ElasticState& start, const Points& positions) {
  const Points mean = (positions - start.positions) / step;
  return scheme == TimeScheme::SecondOrder ? Points(2.0 * mean - start.velocities) : mean;
}

int order_of(TimeScheme scheme) { return scheme == TimeScheme::SecondOrder ? 2 : 1; }

}  // namespace batten
