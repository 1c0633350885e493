#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <random>

#include "batten/error.h"
#include "batten/volume/distance_transform.h"
#include "batten/volume/edge_search.h"
#include "batten/volume/label_mask.h"
#include "batten/volume/points_mask.h"
#include "batten/volume/segment.h"
#include "batten/volume/segment_measures.h"
#include "batten/volume/segment_volume.h"
#include "support/errors.h"
#include "volume/phantoms.h"

namespace batten {
namespace {

/// A bright ball on a dark ground, blurred by about a voxel.
Volume blurred_ball(double radius) {
  return test::made_volume(test::centred_grid(33), [&](const Eigen::Vector3d& at) {
    return 100.0 / (1.0 + std::exp((at.norm() - radius) / 0.5));
  });
}

/// `count` points spread over a ball.
Points points_on_ball(Index count, double radius) {
  Points points(count, 3);
  for (Index i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / count;
    const double turn = 2.399963 * i;
    points.row(i) << std::cos(turn) * std::sqrt(1.0 - z * z), std::sin(turn) * std::sqrt(1.0 - z * z), z;
  }
  return radius * points;
}

TEST(DistanceTransform, EqualsTheNearestOfAll) {
  VolumeGrid grid;
  grid.size = {9, 7, 8};
  grid.axes = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()) * Eigen::Vector3d(1.0, 0.5, 2.5).asDiagonal();
  Buffer<std::uint8_t> flags(static_cast<std::size_t>(grid.count()), 0);
  std::mt19937 random(2);
  for (int n = 0; n < 6; ++n) flags[random() % flags.size()] = 1;
  const Buffer<float> found = distance_transform(grid, flags);
  const auto place = [&](Index voxel) {
    return grid.to_world({voxel % 9 * 1.0, voxel / 9 % 7 * 1.0, voxel / 63 * 1.0});
  };
  for (Index i = 0; i < grid.count(); ++i) {
    double least = std::numeric_limits<double>::infinity();
    for (Index j = 0; j < grid.count(); ++j) {
      if (flags[j] != 0) least = std::min(least, (place(i) - place(j)).norm());
    }
    EXPECT_NEAR(found[i], least, 1e-5);
  }
}

TEST(EdgeSearch, FindsTheStepOfABallFromBothSides) {
  constexpr double kRadius = 9.0;
  const EdgeSearch search(blurred_ball(kRadius), 0.8);
  const Points directions = points_on_ball(200, 1.0);
  for (const double from : {kRadius - 1.5, kRadius + 1.5}) {
    const FoundEdges found = search.find(from * directions, directions, 3.0);
    const Scalars radii = found.places.rowwise().norm();
    // A smoothed edge of a ball lies inwards by about the squared width over the radius.
    EXPECT_NEAR(radii.mean(), kRadius, 0.1) << from;
    EXPECT_LT(radii.maxCoeff() - radii.minCoeff(), 0.5) << from << ": derivatives are linear between voxels";
    EXPECT_GT(found.weights.minCoeff(), 0.5);
  }
}

TEST(EdgeSearch, FindsNothingInAFlatImage) {
  const Volume flat = test::made_volume(test::centred_grid(9), [](const Eigen::Vector3d&) { return 5.0; });
  const Points directions = points_on_ball(20, 1.0);
  const FoundEdges found = EdgeSearch(flat, 1.0).find(2.0 * directions, directions, 2.0);
  EXPECT_EQ(found.places, Points(2.0 * directions));
  EXPECT_TRUE(found.weights.isZero(0.0));
}

TEST(PointsMask, EnclosesWhatIsBetweenThePoints) {
  const Volume mask = points_mask(points_on_ball(150, 10.0), 24);
  double volume = 0.0;
  for (const float value : mask.values) volume += value * mask.grid.voxel_volume();
  const double ball = 4.0 / 3.0 * std::numbers::pi * 1000.0;
  EXPECT_LT(volume, 1.05 * ball);
  EXPECT_GT(volume, 0.75 * ball) << "a polyhedron with its corners on the ball";
}

TEST(PointsMask, RefusesWhatEnclosesNothing) {
  test::expect_error([] { points_mask(points_on_ball(5, 1.0)); }, ErrorCode::BadArgument, "six points");
  Points flat = points_on_ball(30, 1.0);
  flat.col(2).setZero();
  test::expect_error([&] { points_mask(flat); }, ErrorCode::BadArgument, "plane");
}

TEST(PointsOutsideGaps, AreAllOfARoundOrBentBody) {
  EXPECT_EQ(points_outside_gaps(points_on_ball(60, 10.0)).size(), 60U);
  // A tube of width 4 bent to three quarters of a circle of radius 8: its inside is open to a ball.
  const Points dense = points_on_ball(100, 1.0);
  Points bent(100, 3);
  for (Index i = 0; i < 100; ++i) {
    const double turn = 2.3 * dense(i, 2);
    const double around = std::atan2(dense(i, 1), dense(i, 0));
    const double far = 8.0 + 2.0 * std::cos(around);
    bent.row(i) << far * std::cos(turn), far * std::sin(turn), 2.0 * std::sin(around);
  }
  EXPECT_EQ(points_outside_gaps(bent).size(), 100U);
}

TEST(PointsOutsideGaps, AreNotThoseDeepInside) {
  const Points round = points_on_ball(60, 10.0);
  Points points(63, 3);
  points << round.topRows(30), 0.6 * round.row(3), 0.4 * round.row(40), Points::Zero(1, 3), round.bottomRows(30);
  const std::vector<Eigen::Index> rows = points_outside_gaps(points);
  EXPECT_EQ(points(rows, Eigen::all), round);
  SegmentRequest request;
  request.points = points;
  request.surface.vertices = 100;
  const SegmentResult found = segment_volume(blurred_ball(10.0), request);
  EXPECT_EQ(found.left_out, 3);
  EXPECT_EQ(found.slices, 0);
  EXPECT_NEAR(found.measures.volume, 4.0 / 3.0 * std::numbers::pi * 1000.0, 0.02 * found.measures.volume);
}

TEST(SegmentImage, ABallComesOutOfAFewPointsAndTheImage) {
  constexpr double kRadius = 9.0;
  const Volume image = blurred_ball(kRadius);
  const Points points = points_on_ball(40, kRadius);
  SegmentOptions options;
  options.vertices = 100;
  const Segmentation start = segment_mask(points_mask(points, 24), options);
  const Segmentation found = segment_image(start, image, points);
  const SurfaceMeasures before = measure_surface(start.topology, start.scheme, start.mesh);
  const SurfaceMeasures after = measure_surface(found.topology, found.scheme, found.mesh);
  const double ball = 4.0 / 3.0 * std::numbers::pi * kRadius * kRadius * kRadius;
  EXPECT_LT(std::abs(after.volume - ball), 0.02 * ball);
  EXPECT_GT(std::abs(before.volume - ball), std::abs(after.volume - ball));
  EXPECT_EQ(after.self_intersections, 0);
  EXPECT_GT(edge_strength(after.fine, image, 2.0).share(), 0.9);
}

TEST(SegmentImage, WithoutPointsTheEdgesDrawALabel) {
  constexpr double kRadius = 9.0;
  const Volume small = test::made_volume(test::centred_grid(33),
                                         [](const Eigen::Vector3d& at) { return at.norm() < kRadius - 1.5 ? 1 : 0; });
  SegmentOptions options;
  options.vertices = 100;
  const Segmentation found =
      segment_image(segment_mask(label_mask(small, {}), options), blurred_ball(kRadius), Points(0, 3));
  const SurfaceMeasures measures = measure_surface(found.topology, found.scheme, found.mesh);
  EXPECT_NEAR(measures.fine.points.rowwise().norm().mean(), kRadius, 0.3);
}

}  // namespace
}  // namespace batten
