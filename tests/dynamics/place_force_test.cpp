#include "batten/dynamics/place_force.h"

#include <gtest/gtest.h>

#include <limits>

#include "batten/dynamics/pressure.h"
#include "batten/surface/limit_surface.h"
#include "support/errors.h"
#include "support/forces.h"

namespace batten {
namespace {

/// As a spring's from each place to a point that moves.
Eigen::Vector3d pull(const PlaceMotion& motion) {
  return Eigen::Vector3d(motion.time, 2.0, 0.0) - motion.position - 0.5 * motion.velocity + 0.1 * motion.normal;
}

TEST(PlaceForce, OfAFlatSquareIsTheIntegralOfTheFunction) {
  const Mesh mesh = grid(4, 4);
  const PlaceForce force(test::square_of(mesh), pull);
  const Points velocities = Eigen::RowVector3d(0.0, 2.0, 1.0).replicate(mesh.points.rows(), 1);
  const Points forces = test::force_of(force, test::moving(mesh.points, velocities, 0.25));
  EXPECT_NEAR((test::total(forces) - 4.0 * Eigen::Vector3d(0.25, 1.0, -0.4)).norm(), 0.0, 1e-12);
}

TEST(PlaceForce, AlongTheNormalIsPressure) {
  const Mesh mesh = test::jittered(grid(4, 4), 0.1, 1);
  const ElasticSurface body = test::body_of(mesh);
  const PlaceForce force(body, [](const PlaceMotion& motion) { return Eigen::Vector3d(3.0 * motion.normal); },
                         {.points = 3, .levels = 3});
  const test::Motion motion = test::still_at(mesh.points);
  EXPECT_NEAR((test::force_of(force, motion) - test::force_of(Pressure(body, 3.0), motion)).norm(), 0.0, 1e-12);
}

TEST(PlaceForce, TellsThePlaceOfThePosition) {
  const Mesh mesh = test::jittered(dodecahedron(), 0.1, 1);
  const ElasticSurface body = test::body_of(mesh);
  const LimitSurface surface(body.patches(), mesh.points);
  double error = 0.0;
  const PlaceForce force(body, [&](const PlaceMotion& motion) {
    const Jet jet = surface.jet(motion.place);
    error = std::max(error, (jet.point - motion.position).norm());
    error = std::max(error, (jet.du.cross(jet.dv).normalized() - motion.normal).norm());
    return Eigen::Vector3d(0.0, 0.0, 0.0);
  });
  test::force_of(force, test::still_at(mesh.points));
  EXPECT_LT(error, 1e-11);
}

TEST(PlaceForce, ChoosesMorePointsOnLargerFaces) {
  EXPECT_EQ(PlaceForce(test::body_of(cube()), pull).points(), 8);
  EXPECT_EQ(PlaceForce(test::body_of(grid(60, 60)), pull).points(), 2);
  EXPECT_EQ(PlaceForce(test::body_of(cube()), pull, {.points = 3}).points(), 3);
}

TEST(PlaceForce, IsTheSameOnTheRefinedBody) {
  for (const Mesh& mesh : {test::quad_ball(), dodecahedron()}) {
    const ElasticSurface body = test::body_of(mesh);
    test::expect_same_when_refined(PlaceForce(body, pull), body, test::still_at(mesh.points), 1e-3);
  }
}

TEST(PlaceForce, NamesItselfAndThePlaceWhereItIsNotFinite) {
  const Mesh mesh = cube();
  const ElasticSurface body = test::body_of(mesh);
  const PlaceFunction wrong = [](const PlaceMotion& motion) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return Eigen::Vector3d(motion.place.face == 4 ? nan : 0.0, 0.0, 0.0);
  };
  const PlaceForce force(body, wrong, {.name = "magnet"});
  test::expect_error([&] { test::sum_of(force, test::still_at(mesh.points)); }, ErrorCode::NotFinite,
                     "magnet on face 4 at (");
  test::expect_error([&] { PlaceForce(body, {}); }, ErrorCode::BadArgument, "function");
  test::expect_error([&] { PlaceForce(body, pull, {.points = 17}); }, ErrorCode::BadArgument, "points");
}

}  // namespace
}  // namespace batten
