/// \file What a fit has reached, and how.
#pragma once
#include <vector>

#include "batten/nearest/distance_summary.h"
#include "batten/types.h"

namespace batten {

/// Why a fit stopped.
enum class FitEnd {
  Tolerance,  ///< every point lies within it
  Budget,     ///< no more control points allowed, and more rounds gain nothing
  Rounds,     ///< their number was reached
  Cancelled   ///< the progress callback asked to stop; the surface is that of the last whole round
};

/// One round: attach, step.
struct FitRound {
  Index vertices = 0;      ///< of the control mesh
  double fairness = 0.0;   ///< FitStep::fairness
  double max = 0.0;        ///< the greatest distance from a point to the surface after it, outliers left out
  double rms = 0.0;        ///< of these distances
  double objective = 0.0;  ///< SurfaceFitter::objective() before the step
  double after = 0.0;      ///< and after it
  int iterations = 0;      ///< of the linear solver
  double seconds = 0.0;
};

/// Lengths are in the unit of the points.
struct FitReport {
  std::vector<FitRound> rounds;
  DistanceSummary to_surface;  ///< from each point that is no outlier to the surface
  DistanceSummary to_points;   ///< from places spread over the surface to the nearest point; not below their spacing
  double diameter = 0.0;       ///< of the smallest sphere around the points
  double spacing = 0.0;        ///< the median distance between neighbouring points
  Index outliers = 0;          ///< points that were not followed
  Index unsound = 0;           ///< faces of the control mesh whose surface folds over or passes through another's
  FitEnd end = FitEnd::Budget;
  double seconds = 0.0;
};

}  // namespace batten
