#include "batten/energy/level_sums.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "batten/error.h"

namespace batten {

namespace {

using Eigen::MatrixXd;

/// Eigenvalues that differ by less are taken for equal ones: of a Jordan block of three they are found to eps^(1/3).
constexpr double kEqual = 2e-5;
constexpr double kHalf = 0.5;
constexpr int kMostDoublings = 64;
constexpr int kMostSignSteps = 100;

/// Absolute values, descending: the first is the 1 of the constants.
std::vector<double> eigenvalue_sizes(const MatrixXd& matrix) {
  const Eigen::EigenSolver<MatrixXd> solver(matrix, false);
  std::vector<double> sizes;
  for (const auto& eigenvalue : solver.eigenvalues()) sizes.push_back(std::abs(eigenvalue));
  std::sort(sizes.rbegin(), sizes.rend());
  return sizes;
}

/// The projection along the eigenvectors of smaller eigenvalues than `cut` onto the others, from the matrix sign of
/// C - cut by Newton's iteration. Eigenvalues that are defective do no harm.
MatrixXd projection_above(const MatrixXd& step, double cut) {
  const auto count = step.rows();
  const MatrixXd identity = MatrixXd::Identity(count, count);
  MatrixXd sign = step - cut * identity;
  for (int i = 0; i < kMostSignSteps; ++i) {
    const MatrixXd next = 0.5 * (sign + sign.inverse());
    const double change = (next - sign).norm();
    sign = next;
    if (change <= 1e-13 * sign.norm()) return 0.5 * (identity + sign);
  }
  throw Error(ErrorCode::NotConverged, "the tangent plane of an irregular vertex was not found");
}

/// The sum of (E^k)^T X E^k over all k >= 0.
MatrixXd geometric_sum(MatrixXd sum, MatrixXd factor) {
  for (int i = 0; i < kMostDoublings; ++i) {
    const MatrixXd more = factor.transpose() * sum * factor;
    sum += more;
    if (more.norm() <= 1e-17 * sum.norm()) return sum;
    factor = (factor * factor).eval();
  }
  throw Error(ErrorCode::NotConverged, "the levels around an irregular vertex have no finite energy");
}

/// C less its own first row: the same for matrices whose rows and columns sum to zero, and constants are gone.
MatrixXd without_constants(const MatrixXd& step) { return step.rowwise() - step.row(0); }

MatrixXd plate_sum(const MatrixXd& rest, const MatrixXd& step) {
  std::vector<double> sizes = eigenvalue_sizes(step);
  sizes.resize(std::max<std::size_t>(sizes.size(), 3), 0.0);
  const double least = std::max(kHalf, sizes[2]);
  std::size_t kept_out = 1;
  while (kept_out < sizes.size() && sizes[kept_out] >= (1.0 - kEqual) * least) ++kept_out;
  if (kept_out == 1) return geometric_sum(rest, without_constants(step) / kHalf) / (kHalf * kHalf);
  const double next = kept_out < sizes.size() ? sizes[kept_out] : 0.0;
  const double cut = 0.5 * (sizes[kept_out - 1] + next);
  const auto count = step.rows();
  const MatrixXd others = MatrixXd::Identity(count, count) - projection_above(step, cut);
  const MatrixXd first = others.transpose() * rest * others;
  return geometric_sum(first, others * step * others / least) / (least * least);
}

}  // namespace

void remove_constants(MatrixXd& matrix) {
  const auto count = matrix.rows();
  for (Eigen::Index j = 1; j < count; ++j) {
    matrix(0, j) = matrix(j, 0) = -matrix.col(j).tail(count - 1).sum();
  }
  matrix(0, 0) = -matrix.col(0).tail(count - 1).sum();
}

MatrixXd level_sum(EnergyKind kind, const MatrixXd& rest, const MatrixXd& step) {
  MatrixXd sum;
  if (kind == EnergyKind::Mass) {
    sum = 0.25 * geometric_sum(rest, 0.5 * step);
  } else if (kind == EnergyKind::Membrane) {
    sum = geometric_sum(rest, without_constants(step));
  } else {
    sum = plate_sum(rest, step);
  }
  sum = (0.5 * (sum + sum.transpose())).eval();
  if (kind != EnergyKind::Mass) remove_constants(sum);
  return sum;
}

}  // namespace batten
