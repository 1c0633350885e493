/// Prints the comparison of methods as a table and puts it into the report.
#include <fmt/format.h>

#include "cli/compare.h"
#include "cli/table.h"
#include "cli/text.h"

namespace batten::cli {

void print_methods(const std::vector<MethodResult>& results, double diagonal, const CommonArguments& arguments) {
  if (arguments.quiet) return;
  std::FILE* out = text_stream(arguments);
  fmt::print(out, "\n{:<20}  {:>10}  {:>8}  {:>8}  {:>12}  {}\n", "method", "iterations", "build s", "solve s",
             "max error", "how");
  for (const MethodResult& result : results) {
    if (!result.failure.empty()) {
      fmt::print(out, "{:<20}  {}\n", result.name, result.failure);
      continue;
    }
    const double error = diagonal > 0.0 ? result.max_error / diagonal : 0.0;
    const bool direct = result.report.method == SolveMethod::Direct;
    fmt::print(out, "{:<20}  {:>10}  {:>8.4f}  {:>8.4f}  {:>12.2g}  {}{}\n", result.name,
               direct ? "-" : grouped(result.report.iterations), result.build_seconds, result.solve_seconds, error,
               result.report.method_name, result.report.converged ? "" : ": tolerance not reached");
  }
  fmt::print(out, "errors are parts of the diagonal; all iterations run in the same tiles\n");
}

nlohmann::ordered_json methods_json(const std::vector<MethodResult>& results) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const MethodResult& result : results) {
    json.push_back({{"name", result.name},
                    {"method", result.report.method_name},
                    {"failure", result.failure},
                    {"converged", result.report.converged},
                    {"iterations", result.report.iterations},
                    {"build_seconds", result.build_seconds},
                    {"solve_seconds", result.solve_seconds},
                    {"max_error", result.max_error},
                    {"measured_after", result.report.measured_after},
                    {"residual_history", result.report.residual_history}});
  }
  return json;
}

}  // namespace batten::cli
