#include "batten/solve/tiled_iteration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "support/values.h"

namespace batten {
namespace {

using test::random_values;

/// The tensor product of two cyclic (1, 4, 1)/6 matrices on an n-by-n torus: the limit matrix of a regular quad mesh.
/// Rows in `held` keep their values. D^-1 A has the spectrum [1/4, 9/4] (MATH 3).
class TorusRows : public RowSource {
 public:
  explicit TorusRows(Index n, Index held = 0) : n_(n), held_(held) {}
  Index size() const override { return n_ * n_; }
  bool is_free(Index row) const override { return row >= held_; }
  void row(Index row, RowEntries& entries) const override {
    static constexpr double kWeights[] = {1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0};
    for (Index i = 0; i < 3; ++i) {
      for (Index j = 0; j < 3; ++j) {
        const Index u = (row / n_ + i + n_ - 1) % n_;
        const Index v = (row % n_ + j + n_ - 1) % n_;
        entries.add(u * n_ + v, kWeights[i] * kWeights[j]);
      }
    }
  }
  Values times(const Values& x) const {
    Values y = Values::Zero(x.rows(), x.cols());
    RowEntries entries;
    for (Index r = 0; r < size(); ++r) {
      entries.clear();
      row(r, entries);
      for (std::size_t k = 0; k < entries.columns.size(); ++k)
        y.row(r) += entries.weights[k] * x.row(entries.columns[k]);
    }
    return y;
  }

 private:
  Index n_;
  Index held_;
};

IterationOptions options_of(SolveMethod method) {
  IterationOptions options;
  options.method = method;
  return options;
}

TEST(TiledIteration, ChebyshevFindsTheSolutionInManyTiles) {
  const TorusRows rows(150);
  const Values truth = random_values(rows.size(), 3);
  const Values b = rows.times(truth);
  Values x = b;
  const SolveReport report = TiledIteration(rows).solve(b, x, options_of(SolveMethod::Chebyshev), {1e-13, 200, {}});
  EXPECT_TRUE(report.converged);
  EXPECT_LT((x - truth).cwiseAbs().maxCoeff(), 1e-12);  // 1e-13 over the least eigenvalue, 1/9
}

TEST(TiledIteration, HoldsTheRowsThatAreNotFree) {
  const TorusRows rows(60, 500);
  const Values truth = random_values(rows.size(), 2);
  const Values b = rows.times(truth);
  Values x = b;
  x.topRows(500) = truth.topRows(500);
  TiledIteration(rows).solve(b, x, options_of(SolveMethod::Chebyshev), {1e-13, 200, {}});
  EXPECT_TRUE((x.topRows(500).array() == truth.topRows(500).array()).all());
  EXPECT_LT((x - truth).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(TiledIteration, SolvesMoreColumnsThanFitASweep) {
  const TorusRows rows(40);
  const Values truth = random_values(rows.size(), 7);
  const Values b = rows.times(truth);
  Values x = b;
  EXPECT_TRUE(TiledIteration(rows).solve(b, x, options_of(SolveMethod::Chebyshev), {1e-12, 200, {}}).converged);
  EXPECT_LT((x - truth).cwiseAbs().maxCoeff(), 1e-11);
}

/// A tile's steps must be those of the global iteration: damped Jacobi, done plainly in double.
TEST(TiledIteration, IsTheGlobalIterationStepByStep) {
  const TorusRows rows(100);
  const Values b = random_values(rows.size(), 3);
  Values tiled = b;
  TiledIteration(rows).solve(b, tiled, options_of(SolveMethod::Jacobi), {0.0, TiledIteration::kStepsPerRound, {}});
  Values plain = b;
  for (int step = 0; step < TiledIteration::kStepsPerRound; ++step)
    plain += 0.5 * (9.0 / 4.0) * (b - rows.times(plain));
  EXPECT_LT((tiled - plain).cwiseAbs().maxCoeff(), 2e-6);  // the round's correction is a float
}

/// Contraction per step on the slowest mode, regular quads (MATH 3): Lai 8/9, Thall 7/8; Chebyshev tends to 1/2.
double measured_factor(SolveMethod method, double lower_bound) {
  const Index n = 64;
  const TorusRows rows(n);
  Values b(rows.size(), 1);
  for (Index i = 0; i < rows.size(); ++i)
    b(i, 0) = (i / n + i % n) % 2 == 0 ? 1.0 : -1.0;  // the mode of eigenvalue 1/9
  Values x = Values::Zero(rows.size(), 1);
  IterationOptions options = options_of(method);
  options.lower_bound = lower_bound;
  const SolveReport report = TiledIteration(rows).solve(b, x, options, {1e-9, 80, {}});
  const std::vector<double>& history = report.residual_history;
  return std::pow(history[1] / history[0], 1.0 / TiledIteration::kStepsPerRound);
}

TEST(TiledIteration, ThallContractsBySevenEighths) {
  EXPECT_NEAR(measured_factor(SolveMethod::Jacobi, 0.2), 7.0 / 8.0, 1e-6);  // float corrections
}

TEST(TiledIteration, LaiContractsByEightNinths) {
  EXPECT_NEAR(measured_factor(SolveMethod::Richardson, 0.2), 8.0 / 9.0, 1e-6);
}

TEST(TiledIteration, ChebyshevContractsByOneHalf) {
  // Exactly 1/T_8(5/4) = 2/(2^8 + 2^-8) a round of eight steps on the ends of [1/4, 9/4].
  const double round = 2.0 / (std::pow(2.0, 8) + std::pow(2.0, -8));
  EXPECT_NEAR(measured_factor(SolveMethod::Chebyshev, 0.25), std::pow(round, 1.0 / 8.0), 1e-4);
}

TEST(TiledIteration, BoundsTheSpectrumOfRegularQuadsFromAbove) {
  const double bound = TiledIteration(TorusRows(32)).upper_bound();
  EXPECT_GE(bound, 9.0 / 4.0);
  EXPECT_LE(bound, 9.0 / 4.0 * (1.0 + 2e-5));  // computed in float, widened by 1e-5
}

TEST(TiledIteration, ThreadsDoNotChangeABit) {
  const TorusRows rows(120);
  const Values b = random_values(rows.size(), 3);
  const auto solved = [&](int threads) {
    const ThreadLimit limit(threads);
    Values x = b;
    TiledIteration(rows).solve(b, x, options_of(SolveMethod::Chebyshev), {1e-11, 200, {}});
    return x;
  };
  EXPECT_TRUE((solved(1).array() == solved(2).array()).all());
}

TEST(TiledIteration, StopsWhenTheCallbackSaysSo) {
  const TorusRows rows(40);
  const Values b = random_values(rows.size(), 1);
  Values x = b;
  const StopRule stop{1e-13, 1000, [](double /*done*/) { return false; }};
  EXPECT_THROW(TiledIteration(rows).solve(b, x, {}, stop), Error);
}

}  // namespace
}  // namespace batten
