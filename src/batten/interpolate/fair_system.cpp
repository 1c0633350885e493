#include "batten/interpolate/fair_system.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "batten/energy/congruence.h"
#include "batten/refine/sparse_rows.h"
#include "batten/solve/incomplete_factor.h"
#include "batten/solve/krylov.h"
#include "batten/solve/sparse_product.h"

namespace batten {

namespace {

using Matrix = FairSystem::Matrix;

/// Where conjugate gradients need more iterations, as with long smoothing, the whole Cholesky factor takes less time
/// than they do, for some 10,000 unknowns far less; for more than so many its time and memory grow too fast.
constexpr int kFewIterations = 40;
constexpr Eigen::Index kMostFactored = 40000;

/// Unknowns without an energy, such as the points around holes, keep their values: their equation is 1 x = 0.
void hold_unused(Matrix& matrix) {
  for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
    double& diagonal = matrix.coeffRef(r, r);
    if (!(diagonal > 0.0)) diagonal = 1.0;
  }
}

}  // namespace

FairSystem::FairSystem(const LimitMatrix& limit, Index original_count, Scalars position_weights)
    : position_weights_(std::move(position_weights)) {
  const bool passes = position_weights_.size() == 0;
  const Index count = limit.topology().vertex_count();
  unknown_of_.assign(static_cast<std::size_t>(count), -1);
  Index unknowns = 0;
  for (Index v = passes ? original_count : 0; v < count; ++v) unknown_of_[v] = unknowns++;
  std::vector<Eigen::Triplet<double>> entries;
  for (Index v = 0; v < count; ++v) {
    if (v >= original_count) {
      entries.emplace_back(v, unknown_of_[v], 1.0);
      continue;
    }
    VertexWeights row;
    double own = 0.0;
    limit.visit_row(v, [&](Index column, double weight) {
      if (column == v) {
        own += weight;
      } else {
        row.emplace_back(column, weight);
      }
    });
    for (const auto& [column, weight] : row) entries.emplace_back(v, unknown_of_[column], -weight / own);
    if (passes) {
      target_factors_.push_back(1.0 / own);
    } else {
      entries.emplace_back(v, unknown_of_[v], 1.0 / own);
    }
  }
  to_control_.resize(count, unknowns);
  to_control_.setFromTriplets(entries.begin(), entries.end());
  transposed_ = to_control_.transpose();
}

Values FairSystem::unknowns(ConstValuesRef control) const {
  Values result(to_control_.cols(), control.cols());
  for (Index v = 0; v < static_cast<Index>(control.rows()); ++v) {
    if (unknown_of_[v] >= 0) result.row(unknown_of_[v]) = control.row(v);
  }
  // Positions: the rows of T the other way.
  for (Index v = 0; v < static_cast<Index>(position_weights_.size()); ++v) {
    double own = 1.0;
    for (Matrix::InnerIterator entry(to_control_, v); entry; ++entry) {
      if (entry.col() == v) {
        own = entry.value();
      } else {
        result.row(v) -= entry.value() * result.row(entry.col());
      }
    }
    result.row(v) /= own;
  }
  return result;
}

Values FairSystem::control(const Values& unknowns, ConstValuesRef targets) const {
  Values result;
  multiply(to_control_, unknowns, result);
  for (std::size_t v = 0; v < target_factors_.size(); ++v) {
    result.row(static_cast<Eigen::Index>(v)) += target_factors_[v] * targets.row(static_cast<Eigen::Index>(v));
  }
  return result;
}

/// T^T K T y + W y = -T^T K C q + W q; solved for the step from the start, so that large coordinates cost no digits.
SolveReport FairSystem::minimise(const Matrix& energy, ConstValuesRef targets, const FairNormals& normals,
                                 const StopRule& stop, Values& unknowns) const {
  normals.meet(unknowns);
  Matrix reduced = congruence(energy, to_control_);
  Values gradient;
  double level = 0.0;
  {
    Values of_control;
    const Values start = control(unknowns, targets);
    multiply(energy, start, of_control);
    level = start.cwiseProduct(of_control).sum();
    multiply(transposed_, of_control, gradient);
  }
  for (Index i = 0; i < static_cast<Index>(position_weights_.size()); ++i) {
    reduced.coeffRef(i, i) += position_weights_[i];
    gradient.row(i) += position_weights_[i] * (unknowns.row(i) - targets.row(i));
  }
  hold_unused(reduced);
  Values right = -gradient;
  normals.project(right);
  const auto product = [&](const Values& x, Values& y) {
    multiply(reduced, x, y);
    normals.project(y);
  };
  StopRule within = stop;
  within.tolerance *= std::sqrt(std::max(0.0, level));
  Values step = Values::Zero(unknowns.rows(), unknowns.cols());
  const auto iterate = [&](const LinearMap& solve, int most) {
    const auto precondition = [&](const Values& x, Values& y) {
      solve(x, y);
      normals.project(y);
    };
    within.max_iterations = most;
    return conjugate_gradients(product, precondition, normals.empty() ? Coefficients::EachColumn : Coefficients::Joint,
                               right, step, within);
  };
  const bool may_be_factored = normals.empty() && reduced.rows() <= kMostFactored;
  const IncompleteFactor incomplete(reduced);
  SolveReport report = iterate([&](const Values& x, Values& y) { incomplete.solve(x, y); },
                               may_be_factored ? std::min(kFewIterations, stop.max_iterations) : stop.max_iterations);
  if (!report.converged && may_be_factored && report.iterations < stop.max_iterations) {
    const Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> whole{Eigen::SparseMatrix<double>(reduced)};
    const bool is_definite = whole.info() == Eigen::Success;
    const LinearMap solve = [&](const Values& x, Values& y) {
      if (is_definite) {
        y = whole.solve(x);
      } else {
        incomplete.solve(x, y);
      }
    };
    const Values before = step;
    SolveReport rest = iterate(solve, stop.max_iterations - report.iterations);
    if (is_definite) rest.method_name = "sparse Cholesky";
    if (!rest.converged) step = before;  // nearly singular
    report.append(rest, ", then ");
  }
  unknowns += step;
  normals.meet(unknowns);
  return report;
}

}  // namespace batten
