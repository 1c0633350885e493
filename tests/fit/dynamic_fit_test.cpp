#include "batten/fit/dynamic_fit.h"

#include <gtest/gtest.h>

#include "batten/error.h"
#include "batten/io/io.h"
#include "batten/nearest/surface_distances.h"
#include "fit/clouds.h"

namespace batten {
namespace {

using test::CloudMaker;

FitOptions springs(Index vertices) {
  FitOptions options;
  options.method = FitMethod::Dynamic;
  options.start = FitStart::Sphere;
  options.vertices = vertices;
  return options;
}

/// Forces balance under every move, so under a change of size: there springs of stiffness 1 / N give the mean of
/// (point - place) . place, and the body, whose energy is quadratic, twice its energy.
TEST(DynamicFit, EndsWhereForcesBalance) {
  PointCloud cloud{CloudMaker().sphere(1200), Points(0, 3)};
  cloud.points.col(1) *= 0.8;
  cloud.points.col(2) *= 0.6;
  const FitResult fit = fit_surface(cloud, springs(386));
  EXPECT_EQ(fit.topology.vertex_count(), 386);
  EXPECT_EQ(fit.report.end, FitEnd::Budget);
  const SurfaceDistances measured = measure_distances(fit.topology, fit.scheme, fit.mesh.points, cloud.points);
  double of_springs = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < measured.nearest.size(); ++i) {
    const Eigen::Vector3d place = measured.nearest[i].point;
    const Eigen::Vector3d stretch = cloud.points.row(static_cast<Eigen::Index>(i)).transpose() - place;
    of_springs += stretch.dot(place) / 1200.0;
    squares += stretch.squaredNorm() / 1200.0;
  }
  const double of_body = fit.report.rounds.back().after - squares;
  EXPECT_GT(of_body, 0.0);
  EXPECT_NEAR(of_springs, of_body, 0.15 * of_body) << "places still slide along the surface, which takes long";
}

TEST(DynamicFit, NeverRaisesTheEnergyWithinARound) {
  const FitResult fit = fit_surface({CloudMaker().sphere(600), Points(0, 3)}, springs(386));
  ASSERT_GT(fit.report.rounds.size(), 2U);
  Index before = 0;
  for (const FitRound& round : fit.report.rounds) {
    EXPECT_LE(round.after, round.objective * (1.0 + 1e-9));
    EXPECT_GE(round.vertices, before) << "refined, never coarsened";
    before = round.vertices;
  }
  EXPECT_EQ(fit.report.rounds.front().vertices, 98);
}

TEST(DynamicFit, StopsAtTheTolerance) {
  FitOptions options = springs(5000);
  options.tolerance = 0.02;
  const FitResult fit = fit_surface({CloudMaker().sphere(600), Points(0, 3)}, options);
  EXPECT_EQ(fit.report.end, FitEnd::Tolerance);
  EXPECT_LE(fit.report.to_surface.max, 0.02);
  EXPECT_EQ(fit.topology.vertex_count(), 98);
}

TEST(DynamicFit, HasNoSpringsFromOutliers) {
  const Points clean = CloudMaker().sphere(1500);
  const FitResult fit = fit_surface({CloudMaker(5).with_outliers(clean, 0.02), Points(0, 3)}, springs(98));
  const FitResult without = fit_surface({clean, Points(0, 3)}, springs(98));
  EXPECT_GT(fit.report.outliers, 10);
  EXPECT_LT(fit.distances.head(clean.rows()).norm(), 2.0 * without.distances.norm());
}

TEST(DynamicFit, KeepsTheLastWholeRoundWhenCancelled) {
  const PointCloud cloud{CloudMaker().sphere(300), Points(0, 3)};
  bool kept = false;
  for (int most = 5; most < 200; most += 30) {
    int calls = 0;
    double last = 0.0;
    const Progress progress = [&](double share) {
      EXPECT_GE(share, last - 1e-12);
      last = share;
      return ++calls <= most;
    };
    try {
      const FitResult fit = fit_surface(cloud, springs(98), progress);
      if (fit.report.end != FitEnd::Cancelled) break;
      kept = true;
      EXPECT_FALSE(fit.report.rounds.empty());
      EXPECT_NEAR(fit.report.to_surface.rms, fit.report.rounds.back().rms, 1e-9);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::Cancelled);
    }
  }
  EXPECT_TRUE(kept);
}

/// The paper reports 3 % of the diameter for this head with as many control points.
TEST(DynamicFit, FollowsTheHeadAsThePaperDoes) {
  if (test::cloud_folder().empty()) GTEST_SKIP() << "set BATTEN_DATA to the folder of test data";
  const Mesh points = read_mesh(test::cloud_folder() + "head-1779.xyz");
  const FitResult fit = fit_surface({points.points, Points(0, 3)}, springs(386));
  EXPECT_EQ(fit.topology.vertex_count(), 386);
  EXPECT_EQ(fit.report.unsound, 0);
  EXPECT_LT(fit.report.to_surface.max, 0.03 * fit.report.diameter);
}

}  // namespace
}  // namespace batten
