/// \file The formulas of the time schemes, all as (a M + b D + K) P+ = right hand side (docs/mathematics.md).
#pragma once
#include "batten/dynamics/elastic_motion.h"
#include "batten/dynamics/step_system.h"

namespace batten {

/// a and b. step: seconds.
StepWeights step_weights(TimeScheme scheme, double step);

/// a M X + b D Y: what the right hand side has of the state at the step's begin.
Points inertia_force(TimeScheme scheme, double step, const ElasticSurface& surface, const ElasticState& start);

/// True where the force at the begin of the step acts as well as that at its end.
inline bool takes_start_force(TimeScheme scheme) { return scheme == TimeScheme::SecondOrder; }

/// A first guess at the positions at the end.
Points guess_positions(TimeScheme scheme, double step, const ElasticState& start);

/// The velocities at the end.
Points end_velocities(TimeScheme scheme, double step, const ElasticState& start, const Points& positions);

/// p of the error step^(p + 1) of one step.
int order_of(TimeScheme scheme);

}  // namespace batten
