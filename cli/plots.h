/// \file What the verbs plot. Each throws Error(NotAvailable) in a build without plots.
#pragma once
#include <string>
#include <vector>

#include "batten/expand/bands.h"
#include "batten/interpolate/method_comparison.h"

namespace batten::cli {

/// The residual against the iteration, with the tolerance, both in the mesh's unit.
void plot_residuals(const std::string& path, const std::string& title, const SolveReport& report, double tolerance);

/// The residuals of each method against its iterations.
void plot_methods(const std::string& path, const std::vector<MethodResult>& results, double tolerance);

/// The bands' sizes (root mean squares, in the mesh's unit) by how long their bumps are, as given and with their gains.
void plot_bands(const std::string& path, const std::vector<Band>& bands, const std::vector<double>& sizes,
                const std::vector<double>& gains);

/// Energies at times in seconds.
struct EnergyCurves {
  std::vector<double> times;
  std::vector<double> kinetic;
  std::vector<double> elastic;
  std::vector<double> forces;
};

/// The energies of a body and of the forces on it, and their sum, against time.
void plot_energies(const std::string& path, const std::string& title, const EnergyCurves& curves);

}  // namespace batten::cli
