#include "batten/interpolate/method_comparison.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "batten/error.h"
#include "batten/mesh/unit_scale.h"
#include "batten/progress.h"

namespace batten {

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

MethodResult run(const ComparedMethod& compared, const Topology& topology, const Scheme& scheme,
                 InterpolateOptions options, ConstValuesRef targets, const Progress& progress) {
  options.method = compared.method;
  options.omega = kThallsOmega;
  MethodResult result;
  result.name = compared.name;
  try {
    auto start = std::chrono::steady_clock::now();
    constexpr double kBuilt = 0.2;  // of the time
    const Interpolator interpolator(topology, scheme, options, progress_within(progress, 0.0, kBuilt));
    result.build_seconds = seconds_since(start);
    double spent = 0.0;
    for (int runs = 0; runs < kMostRuns && spent < kEnoughSeconds; ++runs) {
      start = std::chrono::steady_clock::now();
      const Progress solving = progress_within(progress, kBuilt, 1.0);
      const double share = 1.0 / kMostRuns;
      Interpolant interpolant = interpolator.solve(targets, progress_within(solving, share * runs, share * (runs + 1)));
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
                                          const InterpolateOptions& options, ConstValuesRef targets,
                                          const Progress& progress) {
  const double scale = unit_scale(targets);
  Values scaled;
  if (scale != 1.0) scaled = scale * targets;
  const Eigen::Ref<const Values, 0, Eigen::OuterStride<>> ordinary =
      scale != 1.0 ? Eigen::Ref<const Values, 0, Eigen::OuterStride<>>(scaled) : targets;
  std::vector<MethodResult> results;
  double done = 0.0;
  for (const ComparedMethod& compared : kComparedMethods) {
    const double next = done + 1.0 / static_cast<double>(std::size(kComparedMethods));
    results.push_back(run(compared, topology, scheme, options, ordinary, progress_within(progress, done, next)));
    results.back().max_error /= scale;
    for (double& residual : results.back().report.residual_history) residual /= scale;
    done = next;
  }
  return results;
}

}  // namespace batten
