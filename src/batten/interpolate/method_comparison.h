/// \file The ways to solve for control points, side by side on one mesh.
#pragma once
#include <string>
#include <vector>

#include "batten/interpolate/interpolator.h"

namespace batten {

/// What one way of solving did.
struct MethodResult {
  std::string name;     ///< "Batten", "Thall 2002", "Lai and Cheng 2006", "direct"
  std::string failure;  ///< why there is no result, or empty
  SolveReport report;
  double build_seconds = 0.0;
  double solve_seconds = 0.0;  ///< of the fastest run
  double max_error = 0.0;      ///< max_i |A P - Q|_i, in the unit of the targets
};

/// Solves for the targets, V-by-k, by Batten's own choice, the iterations of Thall (key Thall02) and of Lai and Cheng
/// (key LC06), and a direct solver, each built once and solved until that took a quarter of a second or five runs.
/// options.method and options.omega do not matter. Throws Error(Cancelled); what else a method throws is its result.
std::vector<MethodResult> compare_methods(const Topology& topology, const Scheme& scheme,
                                          const InterpolateOptions& options, ConstValuesRef targets,
                                          const Progress& progress = {});

}  // namespace batten
