#include "batten/solve/krylov.h"

#include <algorithm>
#include <cmath>

#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// Per column: sum_i weight_i a_ic b_ic, in a tree that does not depend on the threads.
Eigen::RowVectorXd column_dots(const Values& a, const Values& b, const Eigen::VectorXd* weight = nullptr) {
  const Eigen::RowVectorXd zero = Eigen::RowVectorXd::Zero(a.cols());
  return parallel_reduce(
      a.rows(), zero,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        Eigen::RowVectorXd sum = zero;
        for (std::ptrdiff_t i = begin; i < end; ++i) {
          const double w = weight != nullptr ? (*weight)[i] : 1.0;
          for (std::ptrdiff_t c = 0; c < a.cols(); ++c) sum[c] += w * a(i, c) * b(i, c);
        }
        return sum;
      },
      [](const Eigen::RowVectorXd& left, const Eigen::RowVectorXd& right) { return Eigen::RowVectorXd(left + right); });
}

/// Calls body(i) for all rows.
template <typename Body>
void for_rows(std::ptrdiff_t rows, const Body& body) {
  parallel_for(rows, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) body(i);
  });
}

/// a / b per column, and 0 where b is 0 (a column that is solved already).
Eigen::RowVectorXd ratios(const Eigen::RowVectorXd& a, const Eigen::RowVectorXd& b) {
  Eigen::RowVectorXd result(a.size());
  for (std::ptrdiff_t c = 0; c < a.size(); ++c) result[c] = b[c] != 0.0 ? a[c] / b[c] : 0.0;
  return result;
}

SolveReport report_of(SolveMethod method) {
  SolveReport report;
  report.method = method;
  report.method_name = method_name(method);
  return report;
}

}  // namespace

SolveReport conjugate_gradients(const LinearMap& a, const Eigen::VectorXd& scale, const Eigen::VectorXd& diagonal,
                                const Values& b, Values& x, const StopRule& stop) {
  const Stopwatch watch;
  SolveReport report = report_of(SolveMethod::ConjugateGradient);
  const std::ptrdiff_t rows = b.rows();
  Values residual(rows, b.cols());  // unscaled: b - A x
  Values product(rows, b.cols());
  a(x, product);
  residual = b - product;
  const Eigen::VectorXd weight = scale.cwiseProduct(scale).cwiseQuotient(diagonal);  // r.z = sum weight residual^2
  const Eigen::VectorXd step_weight = scale.cwiseQuotient(diagonal);                 // z = step_weight residual
  Values direction(rows, b.cols());
  for_rows(rows, [&](std::ptrdiff_t i) { direction.row(i) = step_weight[i] * residual.row(i); });
  Eigen::RowVectorXd rz = column_dots(residual, residual, &weight);
  report.measured(max_row_norm(residual));
  while (!(report.residual_history.back() <= stop.tolerance) && report.iterations < stop.max_iterations) {
    a(direction, product);
    ++report.iterations;
    const Eigen::RowVectorXd curvature = column_dots(direction, product, &scale);
    for (std::ptrdiff_t c = 0; c < rz.size(); ++c) {
      if (rz[c] > 0.0 && !(curvature[c] > 0.0)) report.indefinite = true;
    }
    if (report.indefinite) {
      report.method_name += " (indefinite)";
      break;
    }
    const Eigen::RowVectorXd alpha = ratios(rz, curvature);
    for_rows(rows, [&](std::ptrdiff_t i) {
      for (std::ptrdiff_t c = 0; c < x.cols(); ++c) {
        x(i, c) += alpha[c] * direction(i, c);
        residual(i, c) -= alpha[c] * product(i, c);
      }
    });
    const Eigen::RowVectorXd rz_next = column_dots(residual, residual, &weight);
    const Eigen::RowVectorXd beta = ratios(rz_next, rz);
    rz = rz_next;
    for_rows(rows, [&](std::ptrdiff_t i) {
      for (std::ptrdiff_t c = 0; c < x.cols(); ++c) {
        direction(i, c) = step_weight[i] * residual(i, c) + beta[c] * direction(i, c);
      }
    });
    report.measured(max_row_norm(residual));
    stop.report(report.residual_history.front(), report.residual_history.back());
  }
  report.converged = report.residual_history.back() <= stop.tolerance;
  report.seconds = watch.seconds();
  return report;
}

namespace {

/// Where the columns are one vector, each has the sum of all columns' products.
Eigen::RowVectorXd products(Coefficients coefficients, const Values& a, const Values& b) {
  Eigen::RowVectorXd dots = column_dots(a, b);
  if (coefficients == Coefficients::EachColumn) return dots;
  return Eigen::RowVectorXd::Constant(dots.size(), dots.sum());
}

/// x += direction diag(factors).
void add_scaled(const Eigen::RowVectorXd& factors, const Values& direction, Values& x) {
  for_rows(x.rows(), [&](std::ptrdiff_t i) {
    for (std::ptrdiff_t c = 0; c < x.cols(); ++c) x(i, c) += factors[c] * direction(i, c);
  });
}

}  // namespace

SolveReport conjugate_gradients(const LinearMap& a, const LinearMap& precondition, Coefficients coefficients,
                                const Values& b, Values& x, const StopRule& stop) {
  const Stopwatch watch;
  SolveReport report = report_of(SolveMethod::ConjugateGradient);
  Values product(b.rows(), b.cols());
  Values z(b.rows(), b.cols());
  a(x, product);
  Values residual = b - product;
  precondition(residual, z);
  Values direction = z;
  Eigen::RowVectorXd rz = products(coefficients, residual, z);
  const double columns = coefficients == Coefficients::Joint ? static_cast<double>(b.cols()) : 1.0;
  const auto measure = [&] { report.measured(std::sqrt(std::max(0.0, rz.sum() / columns))); };
  measure();
  while (!(report.residual_history.back() <= stop.tolerance) && report.iterations < stop.max_iterations) {
    a(direction, product);
    ++report.iterations;
    const Eigen::RowVectorXd curvature = products(coefficients, direction, product);
    report.indefinite = (rz.array() > 0.0 && !(curvature.array() > 0.0)).any();
    if (report.indefinite) break;
    const Eigen::RowVectorXd alpha = ratios(rz, curvature);
    add_scaled(alpha, direction, x);
    add_scaled(-alpha, product, residual);
    precondition(residual, z);
    const Eigen::RowVectorXd rz_next = products(coefficients, residual, z);
    const Eigen::RowVectorXd beta = ratios(rz_next, rz);
    rz = rz_next;
    for_rows(b.rows(), [&](std::ptrdiff_t i) {
      for (std::ptrdiff_t c = 0; c < b.cols(); ++c) direction(i, c) = z(i, c) + beta[c] * direction(i, c);
    });
    measure();
    stop.report(report.residual_history.front(), report.residual_history.back());
  }
  report.converged = report.residual_history.back() <= stop.tolerance;
  report.seconds = watch.seconds();
  return report;
}

namespace {

/// The vectors of stabilised bi-conjugate gradients, and one step of it.
class BiCgStab {
 public:
  BiCgStab(const LinearMap& a, const Eigen::VectorXd& diagonal, const Values& b, Values& x)
      : a_(a), diagonal_(diagonal), b_(b), x_(x), v_(b.rows(), b.cols()), p_hat_(v_), s_hat_(v_), t_(v_) {
    restart();
  }

  double residual_norm() const { return max_row_norm(residual_); }

  /// From the true residual: rounding drives the recursive one away from it.
  void restart() {
    a_(x_, v_);
    residual_ = b_ - v_;
    shadow_ = residual_;
    p_ = residual_;
    rho_ = column_dots(shadow_, residual_);
  }

  /// Two products with A. False when a column came close to breaking down.
  bool step() {
    for_rows(rows(), [&](std::ptrdiff_t i) { p_hat_.row(i) = p_.row(i) / diagonal_[i]; });
    a_(p_hat_, v_);
    const Eigen::RowVectorXd alpha = ratios(rho_, column_dots(shadow_, v_));
    for_rows(rows(), [&](std::ptrdiff_t i) {
      for (std::ptrdiff_t c = 0; c < b_.cols(); ++c) {
        residual_(i, c) -= alpha[c] * v_(i, c);
        s_hat_(i, c) = residual_(i, c) / diagonal_[i];
      }
    });
    a_(s_hat_, t_);
    const Eigen::RowVectorXd omega = ratios(column_dots(t_, residual_), column_dots(t_, t_));
    for_rows(rows(), [&](std::ptrdiff_t i) {
      for (std::ptrdiff_t c = 0; c < b_.cols(); ++c) {
        x_(i, c) += alpha[c] * p_hat_(i, c) + omega[c] * s_hat_(i, c);
        residual_(i, c) -= omega[c] * t_(i, c);
      }
    });
    const Eigen::RowVectorXd rho = column_dots(shadow_, residual_);
    const Eigen::RowVectorXd beta = ratios(rho, rho_).cwiseProduct(ratios(alpha, omega));
    rho_ = rho;
    for_rows(rows(), [&](std::ptrdiff_t i) {
      for (std::ptrdiff_t c = 0; c < b_.cols(); ++c) {
        p_(i, c) = residual_(i, c) + beta[c] * (p_(i, c) - omega[c] * v_(i, c));
      }
    });
    const Eigen::RowVectorXd squares = column_dots(residual_, residual_);
    return !(rho_.array().abs() < 1e-24 * squares.array().max(1e-300)).any();
  }

 private:
  std::ptrdiff_t rows() const { return b_.rows(); }

  const LinearMap& a_;
  const Eigen::VectorXd& diagonal_;
  const Values& b_;
  Values& x_;
  Values residual_;
  Values shadow_;
  Values p_;
  Values v_;
  Values p_hat_;
  Values s_hat_;
  Values t_;
  Eigen::RowVectorXd rho_;
};

}  // namespace

SolveReport bicgstab(const LinearMap& a, const Eigen::VectorXd& diagonal, const Values& b, Values& x,
                     const StopRule& stop) {
  constexpr int kRestartEvery = 100;
  const Stopwatch watch;
  SolveReport report = report_of(SolveMethod::BiCgStab);
  BiCgStab solver(a, diagonal, b, x);
  report.measured(solver.residual_norm());
  while (!(report.residual_history.back() <= stop.tolerance) && report.iterations + 2 <= stop.max_iterations) {
    const bool sound = solver.step();
    report.iterations += 2;
    if (!sound || report.iterations % kRestartEvery == 0) solver.restart();
    report.measured(solver.residual_norm());
    stop.report(report.residual_history.front(), report.residual_history.back());
  }
  report.converged = report.residual_history.back() <= stop.tolerance;
  report.seconds = watch.seconds();
  return report;
}

}  // namespace batten
