#include "batten/solve/tiled_iteration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "support/values.h"

namespace batten {
namespace {

using test::random_values;

/// The tensor product of two cyclic (1, 4, 1)/6 matrices on an n-by-n torus: the limit matrix of a regular quad mesh.
/// Rows in `held` keep their values. D^-1 A has the spectrum [1/4, 9/4] (docs/mathematics.md, Interpolation).
class TorusRows : public RowSource {
 public:
  explicit TorusRows(Index n, Index held = 0) : RowSource(n * n, flags(n * n, held)), n_(n) {}
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
  static Buffer<std::uint8_t> flags(Index size, Index held) {
    Buffer<std::uint8_t> free(static_cast<std::size_t>(size), 1);
    std::fill_n(free.begin(), held, 0);
    return free;
  }
  Index n_;
};

/// 1 on the diagonal, -coupling/4 for each neighbour on an n-by-n torus: the spectrum is [1 - coupling, 1 + coupling],
/// and its lowest mode is the constant one.
class LaplaceRows : public RowSource {
 public:
  LaplaceRows(Index n, double coupling) : RowSource(n * n), n_(n), coupling_(coupling) {}
  void row(Index row, RowEntries& entries) const override {
    const Index i = row / n_;
    const Index j = row % n_;
    entries.add(row, 1.0);
    entries.add((i + 1) % n_ * n_ + j, -0.25 * coupling_);
    entries.add((i + n_ - 1) % n_ * n_ + j, -0.25 * coupling_);
    entries.add(i * n_ + (j + 1) % n_, -0.25 * coupling_);
    entries.add(i * n_ + (j + n_ - 1) % n_, -0.25 * coupling_);
  }

 private:
  Index n_;
  double coupling_;
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

/// Contraction per step on the slowest mode, regular quads (docs/mathematics.md, Interpolation): Lai 8/9, Thall 7/8;
/// Chebyshev tends to 1/2.
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

/// The residual lies on the lowest mode, 0.002, of which the first bound, 0.2, knows nothing: a round of eight steps
/// leaves 0.975 of it. With a bound near 0.0018 the factor a step is exp(-acosh(1.0018)) = 0.94, 390 steps in all.
TEST(TiledIteration, ChebyshevLowersItsBoundBeforeItGivesUp) {
  const LaplaceRows rows(90, 0.998);
  const Values b = Values::Ones(rows.size(), 1);
  Values x = Values::Zero(rows.size(), 1);
  const SolveReport report = TiledIteration(rows).solve(b, x, options_of(SolveMethod::Chebyshev), {1e-10, 1000, {}});
  EXPECT_TRUE(report.converged);
  EXPECT_LT(report.iterations, 500);
  EXPECT_NEAR(x(0), 1.0 / 0.002, 1e-6);  // 1e-10 over the least eigenvalue, and its rounding
}

TEST(TiledIteration, ChebyshevGivesUpOnASingularSystem) {
  const LaplaceRows rows(40, 1.0);
  const Values b = Values::Ones(rows.size(), 1);  // the null vector, which no x reaches
  Values x = Values::Zero(rows.size(), 1);
  const SolveReport report = TiledIteration(rows).solve(b, x, options_of(SolveMethod::Chebyshev), {1e-10, 20000, {}});
  EXPECT_FALSE(report.converged);
  EXPECT_LT(report.iterations, 100);
}

TEST(TiledIteration, ChebyshevLeavesALowSpectrumToABetterMethod) {
  const LaplaceRows rows(40, 0.998);
  const Values b = Values::Ones(rows.size(), 1);
  Values x = Values::Zero(rows.size(), 1);
  IterationOptions options = options_of(SolveMethod::Chebyshev);
  options.give_up_below = 0.03;
  const SolveReport report = TiledIteration(rows).solve(b, x, options, {1e-10, 20000, {}});
  EXPECT_FALSE(report.converged);
  EXPECT_LE(report.iterations, 16);
}

/// A tile and its rings make the same steps as power iteration over all rows, done plainly.
TEST(TiledIteration, BoundsTheSpectrumAsPowerIterationOverAllRowsDoes) {
  const LaplaceRows rows(150, 0.7);
  std::vector<double> u(static_cast<std::size_t>(rows.size()), 1.0);
  double bound = 4.0;
  RowEntries entries;
  for (int step = 0; step < 4; ++step) {
    std::vector<double> next(u.size(), 0.0);
    double most = 0.0;
    for (Index r = 0; r < rows.size(); ++r) {
      entries.clear();
      rows.row(r, entries);
      for (std::size_t k = 0; k < entries.columns.size(); ++k)
        next[r] += std::abs(entries.weights[k]) * u[entries.columns[k]];
      most = std::max(most, next[r] / u[r]);
    }
    bound = std::min(bound, most);
    u = next;
  }
  EXPECT_NEAR(TiledIteration(rows).upper_bound(), bound, 2e-5 * bound);  // computed in float, widened by 1e-5
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
