#include "batten/fit/point_cloud.h"

#include <gtest/gtest.h>

#include "batten/fit/winding_field.h"
#include "fit/clouds.h"
#include "support/errors.h"

namespace batten {
namespace {

using test::CloudMaker;

/// A plane through neighbours within r of a sphere of radius 1 leans by at most about r: 0.25 for 13 of 1,000 points.
TEST(EstimatedNormals, PointOutOfASphere) {
  const Points points = CloudMaker().sphere(1000);
  const Points normals = estimate_normals(points);
  for (Index i = 0; i < 1000; ++i) {
    EXPECT_NEAR(normals.row(i).norm(), 1.0, 1e-12);
    EXPECT_GT(normals.row(i).dot(points.row(i)), 0.95);
  }
}

TEST(EstimatedNormals, PointOutOfEachOfSeveralParts) {
  Points points(1200, 3);
  points << CloudMaker().sphere(600), CloudMaker().sphere(600).rowwise() + Eigen::RowVector3d(5.0, 0.0, 0.0);
  const Points normals = estimate_normals(points);
  for (Index i = 0; i < 600; ++i) {
    EXPECT_GT(normals.row(i).dot(points.row(i)), 0.9);
    EXPECT_GT(normals.row(600 + i).dot(points.row(600 + i) - Eigen::RowVector3d(5.0, 0.0, 0.0)), 0.9);
  }
}

/// A plate of a tenth of its width: two sides that are four spacings apart, and the rim.
TEST(EstimatedNormals, PointAwayFromEachOtherOnAThinPlate) {
  CloudMaker maker;
  Points points(4800, 3);
  for (Index i = 0; i < 4800; ++i) {
    const double along = maker.uniform();
    const double across = maker.uniform();
    if (i < 4000) points.row(i) << along, across, i % 2 == 0 ? 0.1 : 0.0;
    if (i >= 4000) points.row(i) << (i % 2 == 0 ? along : i % 4 / 2), (i % 2 == 0 ? i % 4 / 2 : along), 0.1 * across;
  }
  const Points normals = estimate_normals(points);
  for (Index i = 0; i < 4000; ++i) EXPECT_GT(normals(i, 2) * (i % 2 == 0 ? 1.0 : -1.0), 0.0) << points.row(i);
}

TEST(EstimatedNormals, DoNotDependOnTheOrderOfPoints) {
  const Points points = CloudMaker().torus(500);
  Points reversed = points.colwise().reverse();
  EXPECT_EQ(estimate_normals(points), Points(estimate_normals(reversed).colwise().reverse()));
}

TEST(EstimatedNormals, AreFiniteForFewAndEqualPoints) {
  for (const Index count : {0, 1, 2, 3, 5}) {
    EXPECT_TRUE(estimate_normals(CloudMaker().sphere(count)).allFinite());
    EXPECT_TRUE(estimate_normals(Points::Constant(count, 3, 7.0)).allFinite());
  }
  test::expect_error([] { estimate_normals(Points::Constant(5, 3, std::nan(""))); }, ErrorCode::NotFinite, "point");
  test::expect_error([] { estimate_normals(Values::Zero(5, 2)); }, ErrorCode::BadShape, "three coordinates");
}

/// The solid angle of a closed surface is that of all directions, or nothing.
TEST(WindingField, IsOneInsideAndZeroOutside) {
  const Index count = 4000;
  const Points points = CloudMaker().sphere(count);
  const Scalars areas = Scalars::Constant(count, 4.0 * std::numbers::pi / count);
  const WindingField field(points, points, areas, Scalars::Constant(count, 0.02));
  CloudMaker maker(2);
  for (int i = 0; i < 50; ++i) {
    EXPECT_NEAR(field.value(maker.uniform(0.0, 0.8) * maker.direction()), 1.0, 0.05);
    EXPECT_NEAR(field.value(maker.uniform(1.2, 9.0) * maker.direction()), 0.0, 0.05);
  }
}

/// Against the sum itself, and the fall against differences of values.
TEST(WindingField, EqualsTheSumOverAllPoints) {
  const Index count = 700;
  const Points points = CloudMaker().torus(count);
  const Points normals = CloudMaker(3).sphere(count);
  const Scalars areas = Scalars::Constant(count, 1.0 / count);
  const Scalars widths = Scalars::Constant(count, 0.05);
  const WindingField field(points, normals, areas, widths);
  CloudMaker maker(4);
  for (int i = 0; i < 20; ++i) {
    const Eigen::RowVector3d place = maker.uniform(0.0, 2.0) * maker.direction();
    double sum = 0.0;
    for (Index p = 0; p < count; ++p) {
      const Eigen::RowVector3d way = points.row(p) - place;
      sum += areas(p) * normals.row(p).dot(way) / (4.0 * std::numbers::pi * std::pow(way.squaredNorm() + 0.0025, 1.5));
    }
    EXPECT_NEAR(field.value(place), sum, 0.002);
    const Eigen::RowVector3d fall = field.fall(place);
    for (Index c = 0; c < 3; ++c) {
      const Eigen::RowVector3d step = 1e-6 * Eigen::RowVector3d::Unit(c);
      EXPECT_NEAR(fall(c), (field.value(place - step) - field.value(place + step)) / 2e-6, 0.05);
    }
  }
}

}  // namespace
}  // namespace batten
