#include "batten/dynamics/spring.h"

#include <gtest/gtest.h>

#include <limits>

#include "batten/surface/limit_surface.h"
#include "support/errors.h"
#include "support/forces.h"

namespace batten {
namespace {

std::vector<PointSprings::Spring> two_springs() {
  return {{{3, 0.25, 0.75}, stay_at({3.0, 1.0, 0.5}), 2.0},
          {{5, 0.5, 0.125}, [](double time) { return Eigen::Vector3d(time, 0.0, -4.0); }, 0.5}};
}

TEST(PointSprings, ForceIsMinusTheGradientOfTheEnergy) {
  for (const Mesh& mesh : {test::quad_ball(), dodecahedron()}) {
    test::expect_minus_gradient(PointSprings(test::body_of(mesh), two_springs()), mesh.points);
  }
}

TEST(PointSprings, PullTowardsWhereTheTargetsAreAtTheTime) {
  const Mesh mesh = test::quad_ball();
  const ElasticSurface body = test::body_of(mesh);
  const LimitSurface surface(body.patches(), mesh.points);
  test::Motion motion = test::still_at(mesh.points);
  motion.time = 7.0;
  const Eigen::Vector3d expected = 2.0 * (Eigen::Vector3d(3.0, 1.0, 0.5) - surface.jet({3, 0.25, 0.75}).point) +
                                   0.5 * (Eigen::Vector3d(7.0, 0.0, -4.0) - surface.jet({5, 0.5, 0.125}).point);
  const PointSprings springs(body, two_springs());
  EXPECT_NEAR((test::total(test::force_of(springs, motion)) - expected).norm(), 0.0, 1e-13);
  EXPECT_TRUE(test::sum_of(springs, motion).springs.front().lasting);
}

TEST(PointSprings, AreTheSameOnTheRefinedBody) {
  for (const Mesh& mesh : {test::quad_ball(), dodecahedron()}) {
    const ElasticSurface body = test::body_of(mesh);
    test::expect_same_when_refined(PointSprings(body, two_springs()), body, test::still_at(mesh.points), 1e-13);
  }
}

TEST(PointSprings, NameTheSpringThatIsWrong) {
  const ElasticSurface body = test::body_of(cube());
  const auto make = [&](std::size_t which, const auto& change) {
    return [&body, which, change] {
      std::vector<PointSprings::Spring> springs = two_springs();
      change(springs[which]);
      PointSprings(body, springs);
    };
  };
  test::expect_error(make(1, [](auto& spring) { spring.stiffness = -1.0; }), ErrorCode::BadArgument, "spring 1");
  test::expect_error(make(0, [](auto& spring) { spring.stiffness = std::numeric_limits<double>::infinity(); }),
                     ErrorCode::NotFinite, "spring 0");
  test::expect_error(make(1, [](auto& spring) { spring.place.face = 6; }), ErrorCode::IndexOutOfRange, "spring 1");
  test::expect_error(make(1, [](auto& spring) { spring.place.u = 1.5; }), ErrorCode::BadArgument, "spring 1");
  test::expect_error(make(0, [](auto& spring) { spring.target = {}; }), ErrorCode::BadArgument, "spring 0");
}

TEST(PointSprings, NameTheSpringWhoseTargetIsNotFinite) {
  const Mesh mesh = cube();
  std::vector<PointSprings::Spring> springs = two_springs();
  springs[1].target = [](double) { return Eigen::Vector3d(0.0, std::numeric_limits<double>::quiet_NaN(), 0.0); };
  const PointSprings force(test::body_of(mesh), springs);
  test::expect_error([&] { test::sum_of(force, test::still_at(mesh.points)); }, ErrorCode::NotFinite, "spring 1");
}

}  // namespace
}  // namespace batten
