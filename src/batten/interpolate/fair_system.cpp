#include "batten/interpolate/fair_system.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "batten/energy/congruence.h"
#include "batten/mesh/vertex_order.h"
#include "batten/refine/sparse_rows.h"
#include "batten/solve/cholesky_factor.h"
#include "batten/solve/incomplete_factor.h"
#include "batten/solve/krylov.h"
#include "batten/solve/sparse_product.h"

namespace batten {

namespace {

using Matrix = FairSystem::Matrix;

/// Where conjugate gradients need more iterations, as with long smoothing or with normals that do not suit the points,
/// the whole Cholesky factor takes less time than they do, for some 10,000 unknowns far less; for more than so many its
/// time and memory grow too fast.
constexpr int few_iterations(Eigen::Index unknowns) { return unknowns <= 40000 ? 40 : 200; }
constexpr Eigen::Index kMostFactored = 250000;

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
  for (const Index v : breadth_first_vertices(limit.topology())) {
    if (!passes || v >= original_count) unknown_of_[v] = unknowns++;
  }
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
    const Index unknown = unknown_of_[v];
    double own = 1.0;
    for (Matrix::InnerIterator entry(to_control_, v); entry; ++entry) {
      if (entry.col() == unknown) {
        own = entry.value();
      } else {
        result.row(unknown) -= entry.value() * result.row(entry.col());
      }
    }
    result.row(unknown) /= own;
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

namespace {

/// Least x^T H x / 2 - b^T x over the x that keep the normals' conditions C x = 0, by steps from such an x.
class ConstrainedLeast {
 public:
  ConstrainedLeast(const Matrix& h, const FairNormals& normals, const Values& b, const StopRule& stop)
      : h_(h), normals_(normals), b_(b), stop_(stop) {}

  /// Conjugate gradients among the x that keep the conditions.
  SolveReport iterate(const LinearMap& precondition, int most, Values& x) const;
  /// By the whole factor of H: its multipliers lambda, x = H^-1 (b - C^T lambda), from C H^-1 C^T lambda = C H^-1 b. A
  /// tangent's moment bends the surface no farther than to the next points, which hold it, so that this matrix is
  /// nearly its own diagonal blocks.
  SolveReport solve_multipliers(const CholeskyFactor& factor, int most, Values& x) const;

 private:
  const Matrix& h_;
  const FairNormals& normals_;
  const Values& b_;
  const StopRule& stop_;
};

SolveReport ConstrainedLeast::iterate(const LinearMap& precondition, int most, Values& x) const {
  const LinearMap product = [&](const Values& of, Values& result) {
    multiply(h_, of, result);
    normals_.project(result);
  };
  const LinearMap projected = [&](const Values& of, Values& result) {
    precondition(of, result);
    normals_.project(result);
  };
  Values right = b_;
  normals_.project(right);
  StopRule within = stop_;
  within.max_iterations = most;
  return conjugate_gradients(product, projected, normals_.empty() ? Coefficients::EachColumn : Coefficients::Joint,
                             right, x, within);
}

SolveReport ConstrainedLeast::solve_multipliers(const CholeskyFactor& factor, int most, Values& x) const {
  const std::vector<Eigen::Matrix2d> stiffness = normals_.stiffness(h_);
  const LinearMap give = [&](const Values& of, Values& result) {
    Values pull = Values::Zero(x.rows(), x.cols());
    normals_.add_transposed(of, pull);
    Values moved;
    factor.solve(pull, moved);
    result = normals_.rows(moved);
  };
  const LinearMap precondition = [&](const Values& of, Values& result) {
    for (std::size_t i = 0; i < stiffness.size(); ++i) {
      const auto row = 2 * static_cast<Eigen::Index>(i);
      result.middleRows<2>(row) = stiffness[i] * of.middleRows<2>(row);
    }
  };
  Values free;
  factor.solve(b_, free);
  Values multipliers = Values::Zero(2 * static_cast<Eigen::Index>(normals_.count()), x.cols());
  StopRule within = stop_;
  within.max_iterations = most;
  SolveReport report =
      conjugate_gradients(give, precondition, Coefficients::Joint, normals_.rows(free), multipliers, within);
  Values pull = Values::Zero(x.rows(), x.cols());
  normals_.add_transposed(multipliers, pull);
  factor.solve(b_ - pull, x);
  normals_.project(x);
  return report;
}

}  // namespace

/// T^T K T y + W y = -T^T K C q + W q; solved for the step from the start, so that large coordinates cost no digits.
FairSystem::Least FairSystem::minimise(Matrix energy, ConstValuesRef targets, const FairNormals& normals,
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
  Matrix().swap(energy);  // an assignment would keep its memory
  double start_sum = level;
  for (Index v = 0; v < static_cast<Index>(position_weights_.size()); ++v) {
    const Index i = unknown_of_[v];
    reduced.coeffRef(i, i) += position_weights_[v];
    gradient.row(i) += position_weights_[v] * (unknowns.row(i) - targets.row(v));
    start_sum += position_weights_[v] * (unknowns.row(i) - targets.row(v)).squaredNorm();
  }
  hold_unused(reduced);
  StopRule within = stop;
  within.tolerance *= std::sqrt(std::max(0.0, level));
  const Values right = -gradient;
  const ConstrainedLeast least(reduced, normals, right, within);
  Values step = Values::Zero(unknowns.rows(), unknowns.cols());
  const bool may_be_factored = reduced.rows() <= kMostFactored;
  std::optional<IncompleteFactor> incomplete(reduced);
  const LinearMap by_incomplete = [&](const Values& x, Values& y) { incomplete->solve(x, y); };
  const int few = may_be_factored ? few_iterations(reduced.rows()) : stop.max_iterations;
  SolveReport report = least.iterate(by_incomplete, std::min(few, stop.max_iterations), step);
  const int left = stop.max_iterations - report.iterations;
  if (!report.converged && may_be_factored && left > 0) {
    const CholeskyFactor whole(reduced);
    const LinearMap by_whole = [&](const Values& x, Values& y) { whole.solve(x, y); };
    Values better = step;
    SolveReport rest;
    if (!whole.positive()) {  // to rounding
      rest = least.iterate(by_incomplete, left, better);
    } else {
      incomplete.reset();
      rest = normals.empty() ? least.iterate(by_whole, left, better) : least.solve_multipliers(whole, left, better);
      rest.method_name = "sparse Cholesky";
    }
    if (rest.converged) step = better;
    report.append(rest, ", then ");
  }
  unknowns += step;
  normals.meet(unknowns);
  Values bent;
  multiply(reduced, step, bent);
  const double fall = (bent + 2.0 * gradient).cwiseProduct(step).sum();
  return {start_sum, start_sum + fall, std::move(report)};
}

}  // namespace batten
