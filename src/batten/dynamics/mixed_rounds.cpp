#include "batten/dynamics/mixed_rounds.h"

#include <Eigen/QR>

namespace batten {

Points MixedRounds::next(const Points& before, const Points& after) {
  const Points step = after - before;
  constexpr double kGrowth = 2.0;
  if (last_step_.size() > 0 && step.squaredNorm() > kGrowth * kGrowth * last_step_.squaredNorm()) {
    after_changes_.clear();
    step_changes_.clear();
    last_step_.resize(0, 3);
  }
  if (last_step_.size() > 0) {
    after_changes_.push_back(after - last_after_);
    step_changes_.push_back(step - last_step_);
    if (static_cast<int>(step_changes_.size()) > depth_) {
      after_changes_.erase(after_changes_.begin());
      step_changes_.erase(step_changes_.begin());
    }
  }
  last_after_ = after;
  last_step_ = step;
  const auto count = static_cast<Eigen::Index>(step_changes_.size());
  if (count == 0) return after;
  // Normal equations, scaled: the changes are few, and a rank that is lost only makes the mixture simpler.
  Eigen::MatrixXd products(count, count);
  Eigen::VectorXd right(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      products(i, j) = products(j, i) =
          step_changes_[static_cast<std::size_t>(i)].cwiseProduct(step_changes_[static_cast<std::size_t>(j)]).sum();
    }
    right[i] = step_changes_[static_cast<std::size_t>(i)].cwiseProduct(step).sum();
  }
  const Eigen::VectorXd scale = products.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver(scale.asDiagonal() * products * scale.asDiagonal());
  solver.setThreshold(1e-10);
  const Eigen::VectorXd weights = scale.cwiseProduct(solver.solve(scale.cwiseProduct(right)));
  Points mixed = after;
  for (Eigen::Index i = 0; i < count; ++i) mixed -= weights[i] * after_changes_[static_cast<std::size_t>(i)];
  return mixed;
}

}  // namespace batten
