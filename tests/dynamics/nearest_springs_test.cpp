#include "batten/dynamics/nearest_springs.h"

#include <gtest/gtest.h>

#include <limits>

#include "batten/surface/limit_surface.h"
#include "batten/tessellate/tessellator.h"
#include "support/errors.h"
#include "support/forces.h"

namespace batten {
namespace {

Points points_around(Index count) { return 1.6 * test::random_values(count, 3); }

Points deformed(const Mesh& mesh) {
  Points points = mesh.points;
  points.col(0) *= 1.5;
  points.col(1) += 0.3 * points.col(2);
  return points;
}

/// The nearest vertex of a fine mesh on the surface is farther by less than h^2 / (2 distance) and than h, h half the
/// diagonal of its quads.
TEST(NearestSprings, AreAttachedAsBruteForceSays) {
  const Mesh mesh = test::quad_ball();
  const ElasticSurface body = test::body_of(mesh);
  const Points points = points_around(20);
  const NearestSprings springs(body, points);
  const Points moved = deformed(mesh);
  const std::vector<NearestPoint> attached = springs.attach(moved);
  const Tessellation<double> fine = tessellate<double>(body.topology(), Scheme{}, moved, 5, {true});
  const Points::ConstMapType vertices(fine.points.data(), static_cast<Eigen::Index>(fine.points.size() / 3), 3);
  for (std::size_t i = 0; i < attached.size(); ++i) {
    const Eigen::RowVector3d point = points.row(static_cast<Eigen::Index>(i));
    const double brute = std::sqrt((vertices.rowwise() - point).rowwise().squaredNorm().minCoeff());
    EXPECT_LE(attached[i].distance, brute + 1e-9);
    EXPECT_GE(attached[i].distance, brute - 0.02);
  }
}

TEST(NearestSprings, ForceIsMinusTheGradientOfTheEnergy) {
  for (const Mesh& mesh : {test::quad_ball(), dodecahedron()}) {
    const NearestSprings springs(test::body_of(mesh), points_around(10), {.stiffness = {2.0}});
    test::expect_minus_gradient(springs, deformed(mesh), 1e-5);
  }
}

/// The energy of the places where springs were attached, after a motion, is no less than that where they are then.
TEST(NearestSprings, AttachingAnewNeverRaisesTheEnergy) {
  const Mesh mesh = test::quad_ball();
  const ElasticSurface body = test::body_of(mesh);
  const Points points = points_around(30);
  const NearestSprings springs(body, points);
  const std::vector<NearestPoint> before = springs.attach(mesh.points);
  const Points moved = deformed(mesh);
  const LimitSurface surface(body.patches(), moved);
  double gained = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Eigen::Vector3d point = points.row(static_cast<Eigen::Index>(i));
    const double stays = (surface.jet(before[i].place).point - point).norm();
    const double now = springs.attach(moved)[i].distance;
    EXPECT_LE(0.5 * now * now, 0.5 * stays * stays + stays * springs.tolerance());
    gained += stays - now;
  }
  EXPECT_GT(gained, 0.1);
}

TEST(NearestSprings, ResultsDoNotDependOnWhatWasAskedBefore) {
  const Mesh mesh = test::quad_ball();
  const Points points = points_around(10);
  for (const double radius : {0.0, 0.4}) {
    const NearestSprings springs(test::body_of(mesh), points, {.radius = radius});
    const Points first = test::force_of(springs, test::still_at(mesh.points));
    test::force_of(springs, test::still_at(deformed(mesh)));
    EXPECT_EQ(test::force_of(springs, test::still_at(mesh.points)), first);
  }
}

TEST(NearestSprings, WithARadiusPullAsStronglyAtMorePlaces) {
  const Mesh mesh = test::quad_ball();
  const ElasticSurface body = test::body_of(mesh);
  const Points points = points_around(5);
  const test::Motion motion = test::still_at(deformed(mesh));
  const NearestSprings sharp(body, points);
  const NearestSprings wide(body, points, {.radius = 0.5});
  const Points narrow_forces = test::force_of(sharp, motion);
  const Points wide_forces = test::force_of(wide, motion);
  EXPECT_NEAR((test::total(wide_forces) - test::total(narrow_forces)).norm(), 0.0, 1e-12);
  EXPECT_LT(wide_forces.rowwise().norm().maxCoeff(), 0.8 * narrow_forces.rowwise().norm().maxCoeff());
  const ForceSum sum = test::sum_of(wide, motion);
  EXPECT_NEAR(sum.springs.at(0).stiffness.sum(), 5.0, 1e-12);  // the weights sum to 1
  EXPECT_EQ(sum.energy, test::sum_of(sharp, motion).energy);
}

/// A radius below the spacing of the places, and one that would reach the other side of a thin plate.
TEST(NearestSprings, WithARadiusPullAtTheirOwnSide) {
  Mesh mesh = test::quad_ball();
  mesh.points.col(2) *= 0.05;
  const ElasticSurface body = test::body_of(mesh);
  const Points above = Eigen::RowVector3d(0.1, 0.2, 1.0);
  const test::Motion motion = test::still_at(mesh.points);
  EXPECT_EQ(test::force_of(NearestSprings(body, above, {.radius = 1e-6}), motion),
            test::force_of(NearestSprings(body, above), motion));
  const ForceSum sum = test::sum_of(NearestSprings(body, above, {.radius = 0.5}), motion);
  EXPECT_GT((sum.springs.at(0).rows->rows * mesh.points).col(2).minCoeff(), 0.0);
}

TEST(NearestSprings, AreTheSameOnTheRefinedBody) {
  for (const Mesh& mesh : {test::quad_ball(), dodecahedron()}) {
    const ElasticSurface body = test::body_of(mesh);
    const test::Motion motion = test::still_at(deformed(mesh));
    test::expect_same_when_refined(NearestSprings(body, points_around(8)), body, motion, 1e-6);
    test::expect_same_when_refined(NearestSprings(body, points_around(8), {.radius = 0.4}), body, motion, 0.02);
  }
}

TEST(NearestSprings, RefuseWhatMakesNoSense) {
  const ElasticSurface body = test::body_of(cube());
  const Points points = points_around(3);
  test::expect_error([&] { NearestSprings(body, Values::Zero(3, 2)); }, ErrorCode::BadShape, "three columns");
  test::expect_error(
      [&] {
        NearestSprings(body, points, {.stiffness = {1.0, 2.0}});
      },
      ErrorCode::BadShape, "stiffness");
  test::expect_error(
      [&] {
        NearestSprings(body, points, {.stiffness = {1.0, 2.0, -1.0}});
      },
      ErrorCode::BadArgument, "nearest spring 2");
  test::expect_error([&] { NearestSprings(body, points, {.radius = -1.0}); }, ErrorCode::BadArgument, "radius");
  Points wrong = points;
  wrong(1, 2) = std::numeric_limits<double>::quiet_NaN();
  test::expect_error([&] { NearestSprings(body, wrong); }, ErrorCode::NotFinite, "row 1");
}

}  // namespace
}  // namespace batten
