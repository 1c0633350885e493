#include "batten/dynamics/drag.h"

#include <gtest/gtest.h>

#include <limits>

#include "batten/dynamics/elastic_motion.h"
#include "support/errors.h"
#include "support/forces.h"

namespace batten {
namespace {

test::Motion random_motion(const Mesh& mesh, double step) {
  return test::moving(mesh.points, test::random_values(mesh.vertex_count(), 3), step);
}

TEST(Drag, OnlyTakesEnergyOutInStillAir) {
  for (const Mesh& mesh : {test::quad_ball(), grid(5, 4), dodecahedron()}) {
    for (const auto& [normal, tangential] : {std::pair{1.0, 0.1}, std::pair{0.2, 3.0}, std::pair{0.0, 1.0}}) {
      const Drag drag(test::body_of(mesh), {.wind = {}, .normal = normal, .tangential = tangential});
      const test::Motion motion = random_motion(mesh, 0.01);
      EXPECT_LT(test::force_of(drag, motion).cwiseProduct(motion.velocities).sum(), 0.0);
    }
  }
}

/// A flat square of area 4: 2 against motion along the normal, 0.5 along the surface.
TEST(Drag, OfAFlatSquareIsAreaTimesSpeed) {
  const Mesh mesh = grid(4, 4);
  const Drag drag(test::square_of(mesh), {.wind = steady_wind({1.0, 0.0, 3.0}), .normal = 2.0, .tangential = 0.5});
  const Points velocities = Eigen::RowVector3d(0.0, 2.0, 1.0).replicate(mesh.points.rows(), 1);
  const Points forces = test::force_of(drag, test::moving(mesh.points, velocities, 0.1));
  EXPECT_NEAR((test::total(forces) - Eigen::Vector3d(2.0, -4.0, 16.0)).norm(), 0.0, 1e-12);
}

TEST(Drag, HitsBothSidesOfASheetAlike) {
  Mesh mesh = grid(4, 4);
  const DragOptions options{.wind = steady_wind({0.3, 0.0, 1.0})};
  const Eigen::Vector3d above =
      test::total(test::force_of(Drag(test::body_of(mesh), options), random_motion(mesh, 0.1)));
  mesh.points.col(0) *= -1.0;  // its normals point down
  const test::Motion motion = test::moving(mesh.points, Points::Zero(mesh.points.rows(), 3), 0.1);
  const Eigen::Vector3d below = test::total(test::force_of(Drag(test::body_of(mesh), options), motion));
  mesh.points.col(0) *= -1.0;
  const test::Motion still = test::moving(mesh.points, Points::Zero(mesh.points.rows(), 3), 0.1);
  EXPECT_NEAR((test::total(test::force_of(Drag(test::body_of(mesh), options), still)) - below).norm(), 0.0, 1e-12);
  EXPECT_GT((above - below).norm(), 1e-3);  // motion does matter
}

TEST(Drag, DoesNothingToWhatTheWindCarries) {
  const Mesh mesh = test::quad_ball();
  const Points velocities = Eigen::RowVector3d(1.0, 2.0, 3.0).replicate(mesh.points.rows(), 1);
  const Drag drag(test::body_of(mesh), {.wind = steady_wind({1.0, 2.0, 3.0})});
  EXPECT_NEAR(test::force_of(drag, test::moving(mesh.points, velocities, 0.1)).norm(), 0.0, 1e-12);
}

TEST(Drag, OfAnEquilibriumIsThatOfABodyThatRests) {
  const Mesh mesh = test::jittered(test::quad_ball(), 0.1, 1);
  const WindField wind = [](const Eigen::Vector3d& point, double time) {
    return Eigen::Vector3d(1.0 + time, point.x(), 0.0);
  };
  const Drag drag(test::body_of(mesh), {.wind = wind});
  test::Motion still = test::still_at(mesh.points);
  still.time = 0.25;
  const Points forces = test::force_of(drag, still);
  EXPECT_TRUE(test::sum_of(drag, still).springs.empty());
  still.step = 0.25;
  EXPECT_NEAR((test::force_of(drag, still) - forces).norm(), 0.0, 1e-12 * forces.norm());
}

/// A thousand times as strong as inertia: the sheet is carried along, and never overtakes the wind. A step settles to
/// 1e-6 of the diagonal, which is 2e-4 of the speed.
TEST(Drag, OfLightClothIsStable) {
  const Mesh mesh = grid(4, 4);
  ElasticOptions options;
  options.material.density = {0.01};
  options.material.damping = {0.0};
  const ElasticSurface body(Topology(mesh), Scheme{}, mesh.points, options);
  const auto drag =
      std::make_shared<const Drag>(body, DragOptions{.wind = steady_wind({0.5, 0.0, 1.0}), .normal = 600.0});
  ElasticMotion motion(body, {drag});
  ElasticState state = state_at_rest(body);
  for (int i = 0; i < 20; ++i) {
    motion.step(state);
    EXPECT_LT(state.velocities.col(2).maxCoeff(), 1.0 + 1e-3);
    EXPECT_GT(state.velocities.col(2).minCoeff(), 0.9);
  }
}

TEST(Drag, KeepsRowsAndStiffnessForStepsOfOneLength) {
  const Mesh mesh = test::quad_ball();
  const Drag drag(test::body_of(mesh));
  const ForceSum one = test::sum_of(drag, random_motion(mesh, 0.1));
  const ForceSum other = test::sum_of(drag, random_motion(test::jittered(mesh, 0.2, 3), 0.1));
  ASSERT_TRUE(one.springs.at(0).lasting);
  EXPECT_EQ(one.springs.at(0).rows, other.springs.at(0).rows);
  EXPECT_EQ(one.springs.at(0).stiffness, other.springs.at(0).stiffness);
}

TEST(Drag, IsTheSameOnTheRefinedBody) {
  for (const Mesh& mesh : {test::quad_ball(), dodecahedron()}) {
    const ElasticSurface body = test::body_of(mesh);
    test::expect_same_when_refined(Drag(body, {.wind = steady_wind({1.0, 0.0, 0.0})}), body,
                                   test::moving(mesh.points, Points::Zero(mesh.points.rows(), 3), 0.1), 1e-2);
  }
}

TEST(Drag, NamesThePlaceWhereTheWindIsNotFinite) {
  const Mesh mesh = cube();
  const WindField wind = [](const Eigen::Vector3d& point, double) {
    return Eigen::Vector3d(0.0, point.x() > 0.3 ? std::numeric_limits<double>::quiet_NaN() : 1.0, 0.0);
  };
  const Drag drag(test::body_of(mesh), {.wind = wind});
  test::expect_error([&] { test::sum_of(drag, test::still_at(mesh.points)); }, ErrorCode::NotFinite, "the wind at (0.");
  test::expect_error([&] { Drag(test::body_of(mesh), {.wind = {}, .normal = -1.0}); }, ErrorCode::BadArgument,
                     "normal");
}

}  // namespace
}  // namespace batten
