#include "batten/solve/solver.h"

#include <algorithm>
#include <cmath>

#include "batten/parallel/parallel.h"

namespace batten {

void ErrorSummary::add(const RowError& entry) {
  constexpr std::size_t kKept = 10;
  const auto before = [](const RowError& a, const RowError& b) {
    return a.error != b.error ? a.error > b.error : a.row < b.row;
  };
  squares += entry.error * entry.error;
  if (worst.size() == kKept && !before(entry, worst.back())) return;
  worst.insert(std::upper_bound(worst.begin(), worst.end(), entry, before), entry);
  if (worst.size() > kKept) worst.pop_back();
}

void ErrorSummary::add(const ErrorSummary& other) {
  const double sum = squares + other.squares;
  for (const RowError& entry : other.worst) add(entry);
  squares = sum;
}

void SolveReport::measured(double residual) {
  residual_history.push_back(residual);
  measured_after.push_back(iterations);
}

void SolveReport::append(const SolveReport& next, const std::string& joint) {
  method = next.method;
  if (method_name.empty()) {
    method_name = next.method_name;
  } else if (method_name.find(next.method_name) == std::string::npos) {
    method_name += joint + next.method_name;
  }
  for (const int after : next.measured_after) measured_after.push_back(iterations + after);
  residual_history.insert(residual_history.end(), next.residual_history.begin(), next.residual_history.end());
  iterations += next.iterations;
  seconds += next.seconds;
  converged = next.converged;
  indefinite = next.indefinite;
  errors = next.errors;  // those of the first run were measured before the values changed again
}

std::string method_name(SolveMethod method) {
  switch (method) {
    case SolveMethod::Auto:
      return "none needed";
    case SolveMethod::ConjugateGradient:
      return "conjugate gradients";
    case SolveMethod::BiCgStab:
      return "BiCGSTAB";
    case SolveMethod::Chebyshev:
      return "Chebyshev in tiles";
    case SolveMethod::Jacobi:
      return "damped Jacobi (Thall)";
    case SolveMethod::Richardson:
      return "Richardson (Lai and Cheng)";
    case SolveMethod::Direct:
      return "sparse factors";
  }
  return {};
}

void StopRule::report(double first, double now) const {
  if (!progress) return;
  const double whole = std::log(std::max(first, 1e-300) / std::max(tolerance, 1e-300));
  const double done = whole > 0.0 ? std::log(std::max(first, 1e-300) / std::max(now, 1e-300)) / whole : 1.0;
  report_progress(progress, std::clamp(done, 0.0, 1.0));
}

double max_row_norm(const Values& values) {
  const double squared = parallel_reduce(
      values.rows(), 0.0,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        double most = 0.0;
        for (std::ptrdiff_t i = begin; i < end; ++i) most = larger_or_nan(most, values.row(i).squaredNorm());
        return most;
      },
      larger_or_nan);
  return std::sqrt(squared);
}

}  // namespace batten
