/// \file The words that the solvers share.
#pragma once
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "batten/types.h"

namespace batten {

/// How a system is solved.
enum class SolveMethod {
  Auto,
  ConjugateGradient,  ///< on the symmetric scaled system, diagonal preconditioner
  BiCgStab,           ///< stabilised bi-conjugate gradients, where the rows are not symmetric or not definite
  Chebyshev,          ///< semi-iteration in cache-sized tiles, mixed precision
  Jacobi,             ///< damped Jacobi: Thall's iteration is omega = 1/2
  Richardson,         ///< P + M - A P: Lai and Cheng's series
  Direct              ///< sparse Cholesky, or LU where the system is not symmetric
};

/// How far a row's equation is from holding.
struct RowError {
  Index row;
  double error;  ///< Euclidean length over the columns
};

/// The largest errors and the sum of squares of many rows.
struct ErrorSummary {
  std::vector<RowError> worst;  ///< up to ten, the worst first; of equal ones the lower row
  double squares = 0.0;

  void add(const RowError& entry);
  void add(const ErrorSummary& other);
};

/// What an iteration achieved.
struct SolveReport {
  SolveMethod method = SolveMethod::Auto;  ///< what solved, the last where several were tried; Auto: nothing to solve
  std::string method_name;                 ///< for people, with what was switched to, if anything
  int iterations = 0;                      ///< applications of the matrix
  std::vector<double> residual_history;    ///< max_i |target - A x|_i, each time it was measured, the start included
  std::vector<int> measured_after;         ///< iterations before each entry of residual_history
  double seconds = 0.0;
  bool converged = false;
  bool indefinite = false;  ///< conjugate gradients met a direction of no or negative curvature, and stopped
  ErrorSummary errors;      ///< of the rows solved for, where the method measures them row by row; else empty

  /// Notes a residual, measured after the iterations so far.
  void measured(double residual);
  /// Puts the report of a run that went on from this one's result behind it; `joint` stands between their names.
  void append(const SolveReport& next, const std::string& joint);
};

/// The method's name for people, in lower case but for names; "none needed" for Auto, which solves nothing itself.
std::string method_name(SolveMethod method);

/// Measures the seconds since it was made, for reports.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// When to stop: max_i |residual_i| <= tolerance, or after max_iterations.
struct StopRule {
  double tolerance = 0.0;
  int max_iterations = 10000;
  Progress progress;

  /// Throws Error(Cancelled) when the progress callback says so. Done is a fraction on a logarithmic scale.
  void report(double first, double now) const;
};

/// y = A x, both n-by-k.
using LinearMap = std::function<void(const Values& x, Values& y)>;

/// The larger of two numbers, and NaN where either is.
inline double larger_or_nan(double a, double b) { return b > a || b != b ? b : a; }

/// max over the rows of the row's Euclidean length; 0 for no rows. NaN if any number is.
double max_row_norm(const Values& values);

}  // namespace batten
