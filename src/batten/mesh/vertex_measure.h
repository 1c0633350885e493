/// \file Numbers at vertices in a few words: the greatest, the mean, where.
#pragma once
#include "batten/types.h"

namespace batten {

/// The greatest, the mean and the root of the mean square of numbers at vertices, without those that are NaN.
struct VertexMeasure {
  double max = 0.0;
  double mean = 0.0;
  double rms = 0.0;
  Index worst_vertex = -1;  ///< the lowest one with the greatest number; -1 where there is no number
};

/// O(V).
VertexMeasure measure_numbers(const Scalars& numbers);

/// The angle between two directions of any length, in radians, to rounding also near 0 and pi; NaN where one is zero.
double angle_between(const Eigen::RowVector3d& first, const Eigen::RowVector3d& second);

}  // namespace batten
