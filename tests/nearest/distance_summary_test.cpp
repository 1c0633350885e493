#include "batten/nearest/distance_summary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "batten/error.h"
#include "batten/mesh/primitives.h"
#include "batten/nearest/surface_distances.h"

namespace batten {
namespace {

TEST(DistanceSummary, TellsExtremesMeansAndShares) {
  Scalars distances(4);
  distances << 1.0, -3.0, 2.0, -2.0;
  const DistanceSummary summary = summarize_distances(distances);
  EXPECT_EQ(summary.max, 3.0);
  EXPECT_EQ(summary.max_point, 1);
  EXPECT_DOUBLE_EQ(summary.rms, std::sqrt(18.0 / 4.0));
  EXPECT_EQ(summary.mean, 2.0);
  EXPECT_EQ(summary.median, 2.0);
  EXPECT_EQ(summary.most_of_95, 3.0);
  EXPECT_EQ(summary.most_outside, 2.0);
  EXPECT_EQ(summary.most_inside, 3.0);
  EXPECT_EQ(summary.inside_count, 2);
  EXPECT_EQ(summary.outside_count, 2);
  EXPECT_EQ(summary.on_count, 0);
}

TEST(DistanceSummary, CountsPointsWithinTheToleranceOnNeitherSide) {
  Scalars distances(5);
  distances << 1e-10, -1e-10, 0.0, 2.0, -3.0;
  const DistanceSummary summary = summarize_distances(distances, 1e-10);
  EXPECT_EQ(summary.on_count, 3);
  EXPECT_EQ(summary.outside_count, 1);
  EXPECT_EQ(summary.inside_count, 1);
  EXPECT_EQ(summarize_distances(distances.head(3), 1e-10).most_outside, 0.0);
  EXPECT_EQ(summarize_distances(distances.head(3), 1e-10).max, 1e-10);
}

TEST(Histogram, HasAnEdgeAtZeroAndCountsEveryValueOnce) {
  const Scalars values = Scalars::LinSpaced(101, -0.3, 0.7);
  const Histogram histogram = histogram_of(values, 16);
  EXPECT_LE(histogram.counts.size(), 16U);
  EXPECT_NEAR(std::remainder(histogram.start, histogram.width), 0.0, 1e-12);
  Index all = 0;
  for (const Index count : histogram.counts) all += count;
  EXPECT_EQ(all, 101);
  EXPECT_EQ(histogram_of(Scalars::Constant(5, 2.0)).counts.back(), 5);
}

TEST(FarthestPoints, ComeFirstAndOfEqualOnesTheLower) {
  Scalars distances(5);
  distances << 1.0, -3.0, 3.0, 0.0, 2.0;
  EXPECT_EQ(farthest_points(distances, 3), (std::vector<Index>{1, 2, 4}));
  EXPECT_EQ(farthest_points(distances, 9).size(), 5U);
}

TEST(SamplePoints, KeepTheFarthestAndSpreadTheRest) {
  Scalars distances = Scalars::Zero(1000);
  distances[777] = -5.0;
  const std::vector<Index> sample = sample_points(distances, 100);
  EXPECT_LE(sample.size(), 100U);
  EXPECT_TRUE(std::is_sorted(sample.begin(), sample.end()));
  EXPECT_TRUE(std::binary_search(sample.begin(), sample.end(), 777));
  EXPECT_EQ(sample_points(distances, 1000).size(), 1000U);
}

TEST(SurfaceDistances, AreRefusedWhereTheirSquaresAreInfinite) {
  const Mesh mesh = cube();
  const Topology topology(mesh);
  const Points far = 1e200 * mesh.points;
  for (const auto& [control, points] : {std::pair{far, mesh.points}, std::pair{mesh.points, far}}) {
    try {
      measure_distances(topology, {}, control, points);
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::NotFinite) << error.what();
    }
  }
}

TEST(SurfaceDistances, AreNegativeInsideAClosedSurfaceOnly) {
  Mesh mesh = cube();
  Points points(3, 3);
  points.row(0) = mesh.points.colwise().mean();
  points.row(1) = points.row(0) + Eigen::RowVector3d(10.0, 0.0, 0.0);
  const LimitSurface surface(Topology(mesh), {}, mesh.points);
  points.row(2) = surface.jet({0, 0.25, 0.5}).point.transpose();
  const SurfaceDistances closed = measure_distances(Topology(mesh), {}, mesh.points, points);
  EXPECT_TRUE(closed.closed);
  EXPECT_LT(closed.distances[0], 0.0);
  EXPECT_GT(closed.distances[1], 9.0);
  EXPECT_GE(closed.distances[2], 0.0);
  EXPECT_LE(closed.distances[2], closed.tolerance);
  mesh.holes = {3};
  const SurfaceDistances open = measure_distances(Topology(mesh), {}, mesh.points, points);
  EXPECT_FALSE(open.closed);
  EXPECT_GT(open.distances[0], 0.0);
}

}  // namespace
}  // namespace batten
