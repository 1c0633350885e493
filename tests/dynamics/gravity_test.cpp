#include "batten/dynamics/gravity.h"

#include <gtest/gtest.h>

#include <limits>

#include "support/errors.h"
#include "support/forces.h"

namespace batten {
namespace {

TEST(Gravity, IsMassTimesAcceleration) {
  const Mesh mesh = test::quad_ball();
  ElasticOptions options;
  options.material.density = {0.3};
  const ElasticSurface body(Topology(mesh), Scheme{}, mesh.points, options);
  const Eigen::Vector3d acceleration(1.0, -2.0, 3.0);
  const Points forces = test::force_of(Gravity(body, acceleration), test::still_at(mesh.points));
  EXPECT_NEAR((test::total(forces) - body.mass().sum() * acceleration).norm(), 0.0, 1e-12);
}

/// One acceleration everywhere lets a free body fall without bending it.
TEST(Gravity, MovesAllControlPointsAlike) {
  const Mesh mesh = grid(5, 4);
  const ElasticSurface body = test::body_of(mesh);
  const Points forces = test::force_of(Gravity(body), test::still_at(mesh.points));
  const Points fall = Eigen::RowVector3d(0.0, 0.0, -9.81).replicate(mesh.points.rows(), 1);
  EXPECT_NEAR((body.mass() * fall - forces).norm(), 0.0, 1e-12);
}

TEST(Gravity, ForceIsMinusTheGradientOfTheEnergy) {
  const Mesh mesh = dodecahedron();
  test::expect_minus_gradient(Gravity(test::body_of(mesh)), mesh.points);
}

/// Mass is spread over a face by its parameters, so that smaller faces carry it nearer to where their area is.
TEST(Gravity, IsTheSameOnTheRefinedBody) {
  for (const Mesh& mesh : {test::jittered(test::quad_ball(), 0.1, 2), test::jittered(dodecahedron(), 0.1, 2)}) {
    const ElasticSurface body = test::body_of(mesh);
    test::expect_same_when_refined(Gravity(body), body, test::still_at(mesh.points), 1e-2);
  }
}

TEST(Gravity, RefusesWhatIsNotFinite) {
  const ElasticSurface body = test::body_of(cube());
  test::expect_error(
      [&] {
        Gravity(body, {0.0, std::numeric_limits<double>::infinity(), 0.0});
      },
      ErrorCode::NotFinite, "gravity");
}

}  // namespace
}  // namespace batten
