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

}  // namespace

KrylovReport conjugate_gradients(const LinearMap& a, const Eigen::VectorXd& scale, const Eigen::VectorXd& diagonal,
                                 const Values& b, Values& x, const StopRule& stop) {
  KrylovReport report;
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
  report.residual_history.push_back(max_row_norm(residual));
  while (!(report.residual_history.back() <= stop.tolerance) && report.iterations < stop.max_iterations) {
    a(direction, product);
    ++report.iterations;
    const Eigen::RowVectorXd curvature = column_dots(direction, product, &scale);
    for (std::ptrdiff_t c = 0; c < rz.size(); ++c) {
      if (rz[c] > 0.0 && !(curvature[c] > 0.0)) report.indefinite = true;
    }
    if (report.indefinite) return report;
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
    report.residual_history.push_back(max_row_norm(residual));
    stop.report(report.residual_history.front(), report.residual_history.back());
  }
  report.converged = report.residual_history.back() <= stop.tolerance;
  return report;
}

KrylovReport bicgstab(const LinearMap& a, const Eigen::VectorXd& diagonal, const Values& b, Values& x,
                      const StopRule& stop) {
  KrylovReport report;
  const std::ptrdiff_t rows = b.rows();
  const std::ptrdiff_t columns = b.cols();
  Values residual(rows, columns);
  Values v(rows, columns);
  a(x, v);
  residual = b - v;
  report.residual_history.push_back(max_row_norm(residual));
  Values shadow;
  Values p;
  Values p_hat(rows, columns);
  Values s_hat(rows, columns);
  Values t(rows, columns);
  Eigen::RowVectorXd rho;
  Eigen::RowVectorXd alpha;
  Eigen::RowVectorXd omega;
  const auto restart = [&] {
    shadow = residual;
    p = residual;
    rho = column_dots(shadow, residual);
  };
  restart();
  while (!(report.residual_history.back() <= stop.tolerance) && report.iterations < stop.max_iterations) {
    for_rows(rows, [&](std::ptrdiff_t i) { p_hat.row(i) = p.row(i) / diagonal[i]; });
    a(p_hat, v);
    alpha = ratios(rho, column_dots(shadow, v));
    for_rows(rows, [&](std::ptrdiff_t i) {
      for (std::ptrdiff_t c = 0; c < columns; ++c) {
        residual(i, c) -= alpha[c] * v(i, c);
        s_hat(i, c) = residual(i, c) / diagonal[i];
      }
    });
    a(s_hat, t);
    report.iterations += 2;
    omega = ratios(column_dots(t, residual), column_dots(t, t));
    for_rows(rows, [&](std::ptrdiff_t i) {
      for (std::ptrdiff_t c = 0; c < columns; ++c) {
        x(i, c) += alpha[c] * p_hat(i, c) + omega[c] * s_hat(i, c);
        residual(i, c) -= omega[c] * t(i, c);
      }
    });
    const Eigen::RowVectorXd rho_next = column_dots(shadow, residual);
    const Eigen::RowVectorXd beta = ratios(rho_next, rho).cwiseProduct(ratios(alpha, omega));
    for_rows(rows, [&](std::ptrdiff_t i) {
      for (std::ptrdiff_t c = 0; c < columns; ++c) {
        p(i, c) = residual(i, c) + beta[c] * (p(i, c) - omega[c] * v(i, c));
      }
    });
    const Eigen::RowVectorXd squares = column_dots(residual, residual);
    rho = rho_next;
    // Rounding drives the recursive residual away from the true one, and rho towards 0: start again from where we are.
    const bool stale = (rho.array().abs() < 1e-24 * squares.array().max(1e-300)).any();
    if (stale || report.iterations % 100 == 0) {
      a(x, v);
      residual = b - v;
      restart();
    }
    report.residual_history.push_back(max_row_norm(residual));
    stop.report(report.residual_history.front(), report.residual_history.back());
  }
  report.converged = report.residual_history.back() <= stop.tolerance;
  return report;
}

}  // namespace batten
