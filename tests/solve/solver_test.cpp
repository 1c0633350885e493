#include "batten/solve/solver.h"

#include <gtest/gtest.h>

namespace batten {
namespace {

TEST(SolveReport, AppendedRunsCountOnFromTheOneBefore) {
  SolveReport report;
  report.method = SolveMethod::ConjugateGradient;
  report.method_name = "conjugate gradients (indefinite)";
  report.measured(4.0);
  report.iterations = 3;
  report.measured(2.0);
  report.indefinite = true;
  report.errors.add({5, 2.0});
  SolveReport next;
  next.method = SolveMethod::BiCgStab;
  next.method_name = method_name(next.method);
  next.measured(2.0);
  next.iterations = 8;
  next.measured(0.5);
  next.converged = true;
  report.append(next, ", then ");
  EXPECT_EQ(report.method, SolveMethod::BiCgStab);
  EXPECT_EQ(report.method_name, "conjugate gradients (indefinite), then BiCGSTAB");
  EXPECT_EQ(report.iterations, 11);
  EXPECT_EQ(report.residual_history, (std::vector<double>{4.0, 2.0, 2.0, 0.5}));
  EXPECT_EQ(report.measured_after, (std::vector<int>{0, 3, 3, 11}));
  EXPECT_TRUE(report.converged);
  EXPECT_FALSE(report.indefinite);
  EXPECT_TRUE(report.errors.worst.empty());  // those of the first run were measured before the values changed
}

TEST(SolveReport, ARunThatIsAppendedToNothingKeepsItsName) {
  SolveReport report;
  SolveReport next;
  next.method_name = "sparse LU";
  report.append(next, ", then ");
  EXPECT_EQ(report.method_name, "sparse LU");
}

}  // namespace
}  // namespace batten
