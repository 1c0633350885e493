/// The papers' iterations, ours and a direct solver on the user's own mesh.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "batten/error.h"
#include "cli/common.h"

namespace batten::cli {
namespace {

constexpr int kMostRuns = 5;
constexpr double kEnoughSeconds = 0.25;

struct ComparedMethod {
  const char* name;
  SolveMethod method;
};
constexpr ComparedMethod kComparedMethods[] = {{"Batten", SolveMethod::Auto},
                                               {"Thall 2002", SolveMethod::Jacobi},
                                               {"Lai and Cheng 2006", SolveMethod::Richardson},
                                               {"direct", SolveMethod::Direct}};
constexpr double kThallsOmega = 0.5;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Built once; solved until that took a quarter of a second or five runs, the fastest counts.
MethodResult run(const ComparedMethod& contestant, const Topology& topology, const Scheme& scheme,
                 InterpolateOptions options, ConstValuesRef targets, bool quiet) {
  options.method = contestant.method;
  options.omega = kThallsOmega;
  MethodResult result;
  result.name = contestant.name;
  try {
    auto start = std::chrono::steady_clock::now();
    const Interpolator interpolator(topology, scheme, options, ProgressBar("building", quiet).callback());
    result.build_seconds = seconds_since(start);
    double spent = 0.0;
    for (int runs = 0; runs < kMostRuns && spent < kEnoughSeconds; ++runs) {
      ProgressBar bar(contestant.name, quiet);
      start = std::chrono::steady_clock::now();
      Interpolant interpolant = interpolator.solve(targets, bar.callback());
      const double seconds = seconds_since(start);
      spent += seconds;
      result.solve_seconds = runs == 0 ? seconds : std::min(result.solve_seconds, seconds);
      result.max_error = interpolant.report.max_error;
      result.report = std::move(interpolant.report.solve);
    }
  } catch (const Error& error) {
    if (error.code() == ErrorCode::Cancelled) throw;
    result.failure = error.what();
  }
  return result;
}

}  // namespace

std::vector<MethodResult> compare_methods(const Topology& topology, const Scheme& scheme,
                                          const InterpolateOptions& options, ConstValuesRef targets, bool quiet) {
  std::vector<MethodResult> results;
  for (const ComparedMethod& contestant : kComparedMethods) {
    results.push_back(run(contestant, topology, scheme, options, targets, quiet));
  }
  return results;
}

void print_methods(const std::vector<MethodResult>& results, double diagonal, const CommonArguments& arguments) {
  if (arguments.quiet) return;
  std::FILE* out = arguments.output == "-" ? stderr : stdout;
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
