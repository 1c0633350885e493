#include "cli/plots.h"

#include <algorithm>
#include <cmath>

#include "batten/error.h"
#include "batten/output.h"
#ifdef BATTEN_WITH_RENDER
#include "batten/render/plot.h"
#endif

namespace batten::cli {

#ifdef BATTEN_WITH_RENDER

/// By the extension; an SVG to what has none, such as standard output.
static void write(const std::string& path, const Plot& plot) {
  if (io::is_special_target(path)) return write_bytes(path, encode_svg(plot));
  write_plot(path, plot);
}

void plot_residuals(const std::string& path, const std::string& title, const SolveReport& report, double tolerance) {
  Plot plot;
  plot.title = title;
  plot.x_label = "iterations";
  plot.y_label = "largest residual, in the mesh's unit";
  plot.log_y = true;
  PlotLine line;
  line.x.assign(report.measured_after.begin(), report.measured_after.end());
  line.y = report.residual_history;
  const double last = std::max(1, report.iterations);
  plot.lines = {std::move(line), {"tolerance", {0.0, last}, {tolerance, tolerance}, true}};
  write(path, plot);
}

void plot_methods(const std::string& path, const std::vector<MethodResult>& results, double tolerance) {
  Plot plot;
  plot.title = "Ways to solve for the control points";
  plot.x_label = "iterations";
  plot.y_label = "largest residual, in the mesh's unit";
  plot.log_y = true;
  double last = 1.0;
  for (const MethodResult& result : results) {
    if (result.report.method == SolveMethod::Direct || result.report.residual_history.empty()) continue;
    PlotLine line;
    line.name = result.name;
    line.x.assign(result.report.measured_after.begin(), result.report.measured_after.end());
    line.y = result.report.residual_history;
    last = std::max(last, line.x.back());
    plot.lines.push_back(std::move(line));
  }
  plot.lines.push_back({"tolerance", {0.0, last}, {tolerance, tolerance}, true});
  for (const MethodResult& result : results) {
    if (result.report.method != SolveMethod::Direct || !result.failure.empty()) continue;
    plot.lines.push_back({"direct", {0.0, last}, {result.max_error, result.max_error}, true});
  }
  write(path, plot);
}

void plot_bands(const std::string& path, const std::vector<Band>& bands, const std::vector<double>& sizes,
                const std::vector<double>& gains) {
  Plot plot;
  plot.title = "The bands of a mesh";
  plot.x_label = "band, finest first";
  plot.y_label = "root mean square, in the mesh's unit";
  plot.log_y = true;
  PlotLine given{"as given", {}, {}, false};
  PlotLine mixed{"with their gains", {}, {}, false};
  for (std::size_t j = 0; j < bands.size(); ++j) {
    const double x = static_cast<double>(j) + 1.0;
    given.x.push_back(x);
    given.y.push_back(sizes[j]);
    mixed.x.push_back(x);
    mixed.y.push_back(std::abs(gains[j]) * sizes[j]);
  }
  plot.lines.push_back(std::move(given));
  if (std::any_of(gains.begin(), gains.end(), [](double gain) { return gain != 1.0; }))
    plot.lines.push_back(std::move(mixed));
  write(path, plot);
}

void plot_energies(const std::string& path, const std::string& title, const EnergyCurves& curves) {
  Plot plot;
  plot.title = title;
  plot.x_label = "seconds";
  plot.y_label = "energy";
  std::vector<double> sum = curves.kinetic;
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += curves.elastic[i] + curves.forces[i];
  plot.lines = {{"kinetic", curves.times, curves.kinetic},
                {"elastic", curves.times, curves.elastic},
                {"of forces", curves.times, curves.forces},
                {"sum", curves.times, sum}};
  write(path, plot);
}

#else

void plot_energies(const std::string& /*path*/, const std::string& /*title*/, const EnergyCurves& /*curves*/) {
  throw Error(ErrorCode::NotAvailable, "this build has no plots; configure with BATTEN_WITH_RENDER=ON");
}

void plot_bands(const std::string& /*path*/, const std::vector<Band>& /*bands*/, const std::vector<double>& /*sizes*/,
                const std::vector<double>& /*gains*/) {
  throw Error(ErrorCode::NotAvailable, "this build has no plots; configure with BATTEN_WITH_RENDER=ON");
}

void plot_methods(const std::string& /*path*/, const std::vector<MethodResult>& /*results*/, double /*tolerance*/) {
  throw Error(ErrorCode::NotAvailable, "this build has no plots; configure with BATTEN_WITH_RENDER=ON");
}

void plot_residuals(const std::string& /*path*/, const std::string& /*title*/, const SolveReport& /*report*/,
                    double /*tolerance*/) {
  throw Error(ErrorCode::NotAvailable, "this build has no plots; configure with BATTEN_WITH_RENDER=ON");
}

#endif

}  // namespace batten::cli
