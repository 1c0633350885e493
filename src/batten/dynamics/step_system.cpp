#include "batten/dynamics/step_system.h"

#include <algorithm>
#include <cmath>

#include "batten/error.h"
#include "batten/released_memory.h"
#include "batten/solve/krylov.h"
#include "batten/solve/sparse_product.h"

namespace batten {

namespace {

using Matrix = ElasticSurface::Matrix;

constexpr Index kMostDirect = 400000;
/// From here on factors are in single precision: half the memory, and twice the iterations.
constexpr Index kLeastSingle = 150000;
/// Of a factor in single precision: below, one in double says whether S is singular.
constexpr double kLeastSinglePivot = 1e-5;
/// Relative, of conjugate gradients in place of a direct solve.
constexpr double kDirectTolerance = 1e-12;
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
    : surface_(surface), held_(held), diagonal_(surface.diagonal()), tolerance_(tolerance) {
  release_freed_memory(sizeof(double) * static_cast<std::size_t>(surface.mass().nonZeros()));
  find_matrix(weights, lasting);
  const double inertia =
      (weights.mass + weights.damping * surface.damping_ratio().value_or(0.0)) * mean_diagonal(surface.mass()) +
      (surface.damping_ratio() ? 0.0 : weights.damping * mean_diagonal(surface.damping()));
  unit_ = diagonal_ * std::sqrt(inertia > 0.0 ? inertia : 1e-6 * mean_diagonal(surface.stiffness()));
  const auto rows = static_cast<Eigen::Index>(held.free().size());
  if (rows == 0) return;
  const bool direct = solver == MotionSolver::Direct || (solver == MotionSolver::Auto && rows <= kMostDirect);
  if (direct && mass_weight_ && all_free()) {
    const double* const stiffness = surface.stiffness().valuePtr();
    const double* const mass = surface.mass().valuePtr();
    const double weight = *mass_weight_;
    factorise(surface.stiffness(), [=](std::ptrdiff_t e) { return stiffness[e] + weight * mass[e]; });
    return;
  }
  Matrix sum;
  if (mass_weight_) {
    sum = surface.stiffness();
    sum.coeffs() += *mass_weight_ * surface.mass().coeffs();
  }
  const Matrix& whole = mass_weight_ ? sum : held.pin_count() > 0 ? with_pins_ : matrix_;
  const Matrix part = all_free() ? Matrix() : free_block(whole, held.free());
  const Matrix& block = all_free() ? whole : part;
  if (direct) {
    factorise(block, [&](std::ptrdiff_t e) { return block.valuePtr()[e]; });
  } else {
    incomplete_.emplace(block);
  }
}

/// S is the sum of K and a share of M where that is all it is made of; else a matrix of its own.
void StepSystem::find_matrix(const StepWeights& weights, const std::vector<PlaceSprings>& lasting) {
  const std::optional<double> ratio = surface_.damping_ratio();
  const bool springs = std::any_of(lasting.begin(), lasting.end(),
                                   [](const PlaceSprings& spring) { return spring.rows->rows.rows() > 0; });
  if (ratio && !springs && held_.pin_count() == 0 && same_pattern(surface_.mass(), surface_.stiffness())) {
    mass_weight_ = weights.mass + weights.damping * *ratio;
    return;
  }
  if (ratio) {
    matrix_ = (weights.mass + weights.damping * *ratio) * surface_.mass() + surface_.stiffness();
  } else {
    matrix_ = weights.mass * surface_.mass() + weights.damping * surface_.damping() + surface_.stiffness();
  }
  for (const PlaceSprings& spring : lasting) {
    if (spring.rows->rows.rows() > 0) matrix_ += stiffness_of(*spring.rows, spring.stiffness);
  }
  if (held_.pin_count() > 0) {
    pin_stiffness_ = kPinStiffness * mean_diagonal(matrix_);
    with_pins_ = matrix_ + stiffness_of(held_.pins(), Scalars::Constant(held_.pin_count(), pin_stiffness_));
  }
}

bool StepSystem::all_free() const { return static_cast<Eigen::Index>(held_.free().size()) == surface_.rest().rows(); }

/// product = S x.
void StepSystem::multiply_system(const Values& x, Values& product) const {
  if (mass_weight_) {
    multiply_sum(surface_.stiffness(), *mass_weight_, surface_.mass(), x, product);
  } else {
    multiply(matrix_, x, product);
  }
}

/// Pins are as stiff in the matrix as single precision is fine.
void StepSystem::factorise(const Matrix& pattern, const CholeskyFactor::EntryValue& value) {
  if (pattern.rows() >= kLeastSingle && held_.pin_count() == 0) {
    factor_.emplace(pattern, FactorPrecision::Single, value);
    if (factor_->positive() && factor_->least_pivot() >= kLeastSinglePivot) return;
  }
  factor_.emplace(pattern, FactorPrecision::Double, value);
  if (!factor_->positive() || factor_->least_pivot() < kLeastPivot) {
    throw Error(ErrorCode::SingularSystem,
                "nothing determines where a part of the body goes: it has no mass or damping there, and no support or "
                "spring holds it; give it a density, pin it or attach springs");
  }
}

void StepSystem::precondition(const Values& b, Values& x) const {
  const Buffer<Index>& free = held_.free();
  const auto solve = [&](const Values& right, Values& solution) {
    if (factor_) factor_->solve(right, solution);
    if (incomplete_) incomplete_->solve(right, solution);
  };
  if (all_free()) {
    solve(b, x);
    return;
  }
  Values gathered(static_cast<Eigen::Index>(free.size()), 3);
  for (std::size_t i = 0; i < free.size(); ++i) gathered.row(static_cast<Eigen::Index>(i)) = b.row(free[i]);
  Values solved;
  solve(gathered, solved);
  x.setZero(b.rows(), 3);
  for (std::size_t i = 0; i < free.size(); ++i) x.row(free[i]) = solved.row(static_cast<Eigen::Index>(i));
}

/// right + J^T (multipliers + r (d - J P)) - S P + the springs' forces: zero where P solves the system.
Values StepSystem::residual(const Round& round, const Extra& extra, const Points& start,
                            const Points& positions) const {
  Values result;
  multiply_system(positions, result);
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
  const bool direct = factor_ && extra.empty();
  if (direct && factor_->precision() == FactorPrecision::Double) {
    precondition(right, step);
    positions += step;
    return 0;
  }
  std::vector<bool> is_free(static_cast<std::size_t>(right.rows()), false);
  for (const Index v : held_.free()) is_free[static_cast<std::size_t>(v)] = true;
  const auto keep_free = [&](Values& values) {
    if (all_free()) return;
    for (Eigen::Index v = 0; v < values.rows(); ++v) {
      if (!is_free[static_cast<std::size_t>(v)]) values.row(v).setZero();
    }
  };
  const LinearMap apply = [&](const Values& x, Values& product) {
    if (held_.pin_count() > 0) {
      multiply(with_pins_, x, product);
    } else {
      multiply_system(x, product);
    }
    extra.add(x, product);
    keep_free(product);
  };
  Values b = right;
  keep_free(b);
  step.setZero(right.rows(), 3);
  StopRule stop;
  stop.tolerance = (direct ? std::min(kDirectTolerance, tolerance_) : tolerance_) * unit_;
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
