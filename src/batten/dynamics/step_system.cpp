#include "batten/dynamics/step_system.h"

#include <algorithm>
#include <cmath>

#include "batten/error.h"
#include "batten/solve/krylov.h"
#include "batten/solve/sparse_product.h"

namespace batten {

namespace {

using Matrix = ElasticSurface::Matrix;

constexpr Index kMostDirect = 150000;
/// r, relative to the mean of S's diagonal.
constexpr double kPinStiffness = 1e6;
constexpr int kMostPinSolves = 8;
constexpr double kPinTolerance = 1e-13;  ///< relative to the diagonal
/// Relative to S's own diagonal: below, S is singular but for rounding.
constexpr double kLeastPivot = 1e-13;

Matrix stiffness_of(const PlaceRows& rows, const Scalars& stiffness) {
  return rows.transposed * Matrix(stiffness.asDiagonal() * rows.rows);
}

/// Rows and columns of the free control points.
Matrix free_block(const Matrix& matrix, const Buffer<Index>& free) {
  Buffer<Index> number(static_cast<std::size_t>(matrix.rows()), -1);
  for (std::size_t i = 0; i < free.size(); ++i) number[free[i]] = static_cast<Index>(i);
  Matrix block(static_cast<Eigen::Index>(free.size()), static_cast<Eigen::Index>(free.size()));
  block.reserve(matrix.nonZeros());
  for (std::size_t i = 0; i < free.size(); ++i) {
    block.startVec(static_cast<Eigen::Index>(i));
    for (Matrix::InnerIterator e(matrix, free[i]); e; ++e) {
      if (number[e.col()] >= 0) block.insertBack(static_cast<Eigen::Index>(i), number[e.col()]) = e.value();
    }
  }
  block.finalize();
  return block;
}

double mean_diagonal(const Matrix& matrix) {
  return matrix.rows() == 0 ? 0.0 : matrix.diagonal().sum() / static_cast<double>(matrix.rows());
}

}  // namespace

/// The springs that change, and what they and the stiff directions do to positions.
struct StepSystem::Extra {
  std::vector<const PlaceSprings*> springs;
  const std::vector<ForceSum::Along>& along;

  explicit Extra(const ForceSum& sum) : along(sum.along) {
    for (const PlaceSprings& spring : sum.springs) {
      if (!spring.lasting && spring.rows->rows.rows() > 0) springs.push_back(&spring);
    }
  }
  bool empty() const { return springs.empty() && along.empty(); }
  /// Each coordinate by itself.
  bool is_by_columns() const {
    const auto pulls_all_ways = [](const PlaceSprings* spring) { return spring->directions.size() == 0; };
    return along.empty() && std::all_of(springs.begin(), springs.end(), pulls_all_ways);
  }

  /// product += stiffness * x.
  void add(const Values& x, Values& product) const {
    Values at;
    Values back;
    for (const PlaceSprings* spring : springs) {
      multiply(spring->rows->rows, x, at);
      turn_into_forces(*spring, at);
      multiply(spring->rows->transposed, at, back);
      product += back;
    }
    for (const ForceSum::Along& one : along) {
      product += (one.stiffness * one.direction.cwiseProduct(x).sum()) * one.direction;
    }
  }
};

StepSystem::StepSystem(const ElasticSurface& surface, const StepWeights& weights,
                       const std::vector<PlaceSprings>& lasting, const HeldPoints& held, MotionSolver solver,
                       double tolerance)
    : held_(held), diagonal_(surface.diagonal()) {
  const Matrix inertia = weights.mass * surface.mass() + weights.damping * surface.damping();
  matrix_ = inertia + surface.stiffness();
  for (const PlaceSprings& springs : lasting) {
    if (springs.rows->rows.rows() > 0) matrix_ += stiffness_of(*springs.rows, springs.stiffness);
  }
  if (held.pin_count() > 0) {
    pin_stiffness_ = kPinStiffness * mean_diagonal(matrix_);
    with_pins_ = matrix_ + stiffness_of(held.pins(), Scalars::Constant(held.pin_count(), pin_stiffness_));
  }
  const double mean = mean_diagonal(inertia) > 0.0 ? mean_diagonal(inertia) : 1e-6 * mean_diagonal(matrix_);
  tolerance_ = tolerance * diagonal_ * std::sqrt(mean);
  const Matrix block = free_block(held.pin_count() > 0 ? with_pins_ : matrix_, held.free());
  const bool direct = solver == MotionSolver::Direct || (solver == MotionSolver::Auto && block.rows() <= kMostDirect);
  if (block.rows() == 0) return;
  if (!direct) {
    incomplete_.emplace(block);
    return;
  }
  factor_.emplace(block);
  if (!factor_->positive() || factor_->least_pivot() < kLeastPivot) {
    throw Error(ErrorCode::SingularSystem,
                "nothing determines where a part of the body goes: it has no mass or damping there, and no support or "
                "spring holds it; give it a density, pin it or attach springs");
  }
}

void StepSystem::precondition(const Values& b, Values& x) const {
  const Buffer<Index>& free = held_.free();
  Values gathered(static_cast<Eigen::Index>(free.size()), 3);
  for (std::size_t i = 0; i < free.size(); ++i) gathered.row(static_cast<Eigen::Index>(i)) = b.row(free[i]);
  Values solved;
  if (factor_) factor_->solve(gathered, solved);
  if (incomplete_) incomplete_->solve(gathered, solved);
  x.setZero(b.rows(), 3);
  for (std::size_t i = 0; i < free.size(); ++i) x.row(free[i]) = solved.row(static_cast<Eigen::Index>(i));
}

/// right + J^T (multipliers + r (d - J P)) - S P + the springs' forces: zero where P solves the system.
Values StepSystem::residual(const Round& round, const Extra& extra, const Points& start,
                            const Points& positions) const {
  Values result;
  multiply(matrix_, positions, result);
  result = round.right - result;
  if (held_.pin_count() > 0) {
    const Points pull = round.multipliers + pin_stiffness_ * (round.places.pins - held_.pins().rows * positions);
    result += held_.pins().transposed * pull;
  }
  for (const PlaceSprings& spring : round.sum.springs) {
    if (spring.rows->rows.rows() == 0) continue;
    // S has the stiffness of lasting springs already.
    Values stretch = spring.targets;
    if (!spring.lasting) stretch -= spring.rows->rows * positions;
    turn_into_forces(spring, stretch);
    Values force;
    multiply(spring.rows->transposed, stretch, force);
    result += force;
  }
  for (const ForceSum::Along& one : extra.along) {
    result -= (one.stiffness * one.direction.cwiseProduct(positions - start).sum()) * one.direction;
  }
  return result;
}

/// positions += the solution for `right`. Returns the iterations.
int StepSystem::correct(const Extra& extra, const Values& right, const Progress& progress, Points& positions) const {
  Values step;
  if (factor_ && extra.empty()) {
    precondition(right, step);
    positions += step;
    return 0;
  }
  const Matrix& matrix = held_.pin_count() > 0 ? with_pins_ : matrix_;
  std::vector<bool> is_free(static_cast<std::size_t>(right.rows()), false);
  for (const Index v : held_.free()) is_free[static_cast<std::size_t>(v)] = true;
  const auto keep_free = [&](Values& values) {
    for (Eigen::Index v = 0; v < values.rows(); ++v) {
      if (!is_free[static_cast<std::size_t>(v)]) values.row(v).setZero();
    }
  };
  const LinearMap apply = [&](const Values& x, Values& product) {
    multiply(matrix, x, product);
    extra.add(x, product);
    keep_free(product);
  };
  Values b = right;
  keep_free(b);
  step.setZero(right.rows(), 3);
  StopRule stop;
  stop.tolerance = tolerance_;
  stop.max_iterations = 2000;
  stop.progress = progress;
  const SolveReport report = conjugate_gradients(
      apply, [&](const Values& x, Values& z) { precondition(x, z); },
      extra.is_by_columns() ? Coefficients::EachColumn : Coefficients::Joint, b, step, stop);
  positions += step;
  return report.iterations;
}

StepSolve StepSystem::solve(const Round& round, Points& positions) const {
  const Extra extra(round.sum);
  const Points start = positions;
  StepSolve result;
  held_.lead(round.places, positions);
  for (int i = 0; i < kMostPinSolves; ++i) {
    result.iterations += correct(extra, residual(round, extra, start, positions), round.progress, positions);
    if (held_.pin_count() == 0) return result;
    const Points missing = round.places.pins - held_.pins().rows * positions;
    round.multipliers += pin_stiffness_ * missing;
    result.support_error = missing.rowwise().norm().maxCoeff();
    if (result.support_error <= kPinTolerance * diagonal_) break;
  }
  return result;
}

}  // namespace batten
