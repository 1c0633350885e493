#include "batten/dynamics/contact.h"

#include <gtest/gtest.h>

#include <limits>

#include "batten/dynamics/elastic_motion.h"
#include "batten/dynamics/gravity.h"
#include "batten/dynamics/surface_samples.h"
#include "support/errors.h"
#include "support/forces.h"

namespace batten {
namespace {

const SignedDistance kFloor = plane_obstacle({0.0, 0.0, -0.5}, {0.0, 0.0, 2.0});

std::vector<SignedDistance> obstacles() {
  return {kFloor, sphere_obstacle({0.1, 0.2, 1.2}, 0.8), box_inside_obstacle({-0.6, -0.7, -2.0}, {0.5, 0.6, 2.0})};
}

TEST(Obstacles, GradientsAreThoseOfTheDistance) {
  const Values points = 1.5 * test::random_values(60, 3);
  for (const SignedDistance& obstacle : obstacles()) {
    for (Index i = 0; i < points.rows(); ++i) {
      const Eigen::Vector3d point = points.row(i);
      Eigen::Vector3d gradient;
      Eigen::Vector3d unused;
      obstacle(point, gradient);
      for (int c = 0; c < 3; ++c) {
        const Eigen::Vector3d way = 1e-6 * Eigen::Vector3d::Unit(c);
        const double slope = (obstacle(point + way, unused) - obstacle(point - way, unused)) / 2e-6;
        EXPECT_NEAR(gradient.normalized()[c], slope, 1e-6);
      }
    }
  }
}

TEST(Obstacles, AreWhereTheyShallBe) {
  Eigen::Vector3d gradient;
  EXPECT_NEAR(kFloor({5.0, 5.0, 0.0}, gradient), 0.5, 1e-15);
  EXPECT_NEAR(sphere_obstacle({1.0, 0.0, 0.0}, 2.0)({1.0, 0.0, 0.0}, gradient), -2.0, 1e-15);
  EXPECT_NEAR(gradient.norm(), 1.0, 1e-15);
  const SignedDistance box = box_inside_obstacle({0.0, 0.0, 0.0}, {1.0, 2.0, 3.0});
  EXPECT_NEAR(box({0.5, 1.0, 2.75}, gradient), 0.25, 1e-15);
  EXPECT_NEAR(box({4.0, 6.0, 1.0}, gradient), -5.0, 1e-15);
}

TEST(Contact, ForceIsMinusTheGradientOfTheEnergy) {
  for (const Mesh& mesh : {test::quad_ball(), dodecahedron()}) {
    for (const SignedDistance& obstacle : obstacles()) {
      const Contact contact(test::body_of(mesh), obstacle, {.stiffness = 10.0, .thickness = 0.05});
      EXPECT_GT(test::sum_of(contact, test::still_at(mesh.points)).energy, 0.0);
      test::expect_minus_gradient(contact, mesh.points, 1e-5);
    }
  }
}

TEST(Contact, DoesNothingOutside) {
  const Mesh mesh = test::quad_ball();
  const Contact contact(test::body_of(mesh), plane_obstacle({0.0, 0.0, -1.01}, {0.0, 0.0, 1.0}));
  const ForceSum sum = test::sum_of(contact, test::still_at(mesh.points));
  EXPECT_TRUE(sum.springs.empty());
  EXPECT_EQ(sum.force.norm(), 0.0);
  EXPECT_EQ(sum.energy, 0.0);
}

TEST(Contact, PushesOutAlongTheGradient) {
  const Mesh mesh = test::quad_ball();
  const Points forces =
      test::force_of(Contact(test::body_of(mesh), kFloor, {.stiffness = 10.0}), test::still_at(mesh.points));
  EXPECT_GT(forces.col(2).minCoeff(), -1e-15);
  EXPECT_GT(forces.col(2).sum(), 0.1);
  EXPECT_NEAR(forces.leftCols<2>().norm(), 0.0, 1e-14);
}

/// A flat sheet of area 4 at a depth of 0.1: each place counts its part of the area.
TEST(Contact, OfASheetIsStiffnessTimesAreaTimesDepth) {
  for (const auto& [mesh, scheme] :
       {std::pair{grid(4, 3), Scheme{}},
        std::pair{test::with_faces(grid(1, 1), {{0, 1, 3}, {0, 3, 2}}), Scheme{SchemeKind::Loop}}}) {
    const ElasticSurface body = test::body_of(mesh, scheme);
    const double area = element_areas(body.patches(), mesh.points).sum();
    const Contact contact(body, plane_obstacle({0.0, 0.0, 0.05}, {0.0, 0.0, 1.0}),
                          {.stiffness = 10.0, .thickness = 0.05, .intervals = 3});
    const ForceSum sum = test::sum_of(contact, test::still_at(mesh.points));
    EXPECT_NEAR(test::total(test::force_of(contact, test::still_at(mesh.points))).z(), area, 1e-10);
    EXPECT_NEAR(sum.energy, 0.05 * area, 1e-10);
  }
}

TEST(Contact, FindsAllThatIsNearThoughItSkipsFacesFarAway) {
  const Mesh mesh = test::jittered(test::quad_ball(), 0.05, 4);
  const ElasticSurface body = test::body_of(mesh);
  const SurfaceSamples samples(body.patches(), GridSamples{3});
  const Points points = samples.evaluate(mesh.points);
  const Scalars areas = element_areas(body.patches(), mesh.points);
  for (const SignedDistance& obstacle : obstacles()) {
    double energy = 0.0;
    for (std::ptrdiff_t i = 0; i < samples.count(); ++i) {
      Eigen::Vector3d gradient;
      const double depth = std::max(0.0, 1.0 - obstacle(points.row(i), gradient));
      energy += 0.5 * 10.0 * areas[samples.element_of(i)] * samples.weight(i) * depth * depth;
    }
    const Contact contact(body, obstacle, {.stiffness = 10.0, .thickness = 1.0, .intervals = 3});
    EXPECT_NEAR(test::sum_of(contact, test::still_at(mesh.points)).energy, energy, 1e-12 * energy);
  }
}

/// A sheet 0.1 deep that slips by `slip` in a step: friction against it over what pushes out.
double friction_over_load(double slip, double friction) {
  const Mesh mesh = grid(4, 3);
  const Contact contact(test::body_of(mesh), plane_obstacle({0.0, 0.0, 0.1}, {0.0, 0.0, 1.0}),
                        {.stiffness = 10.0, .friction = friction});
  const Points velocities = Eigen::RowVector3d(slip / 0.1, 0.0, 0.3).replicate(mesh.points.rows(), 1);
  const Eigen::Vector3d force = test::total(test::force_of(contact, test::moving(mesh.points, velocities, 0.1)));
  EXPECT_NEAR(force.y(), 0.0, 1e-12);
  return -force.x() / force.z();
}

TEST(Contact, HoldsBelowTheFrictionCoefficient) {
  EXPECT_NEAR(friction_over_load(0.02, 0.3), 0.2, 1e-12);  // sticks: as a spring would, way over depth
  EXPECT_NEAR(friction_over_load(0.03 - 1e-9, 0.3), 0.3, 1e-7);
  EXPECT_NEAR(friction_over_load(0.03 + 1e-9, 0.3), 0.3, 1e-12);
  EXPECT_NEAR(friction_over_load(0.5, 0.3), 0.3, 1e-12);  // slides
  EXPECT_NEAR(friction_over_load(0.5, 0.0), 0.0, 1e-12);
}

TEST(Contact, TellsAlongWhatSpringsPull) {
  const Mesh mesh = grid(2, 2);
  const Contact contact(test::body_of(mesh), plane_obstacle({0.0, 0.0, 0.1}, {0.0, 0.0, 1.0}), {.friction = 0.5});
  const auto directions = [&](double speed) {
    const Points velocities = Eigen::RowVector3d(speed, 0.0, 0.0).replicate(mesh.points.rows(), 1);
    return test::sum_of(contact, test::moving(mesh.points, velocities, 0.1)).springs.at(0).directions;
  };
  EXPECT_EQ(directions(10.0), Points(Eigen::RowVector3d(0.0, 0.0, 1.0).replicate(36, 1)));
  EXPECT_EQ(directions(0.01).norm(), 0.0);
}

/// The speed along a plane tilted by atan 0.5, of a flat sheet that has fallen on it from rest 0.5 seconds ago.
double sliding_speed(double friction) {
  Mesh mesh = grid(3, 3);
  const Eigen::Vector3d along = Eigen::Vector3d(2.0, 0.0, -1.0).normalized();
  mesh.points.col(2) = -0.5 * mesh.points.col(0);
  ElasticOptions options;
  options.material.damping = {0.0};
  const ElasticSurface body(Topology(mesh), Scheme{}, mesh.points, options);
  const auto weight = std::make_shared<const Gravity>(body);
  const auto plane = std::make_shared<const Contact>(body, plane_obstacle({0.0, 0.0, 0.0}, {1.0, 0.0, 2.0}),
                                                     ContactOptions{.stiffness = 1e4, .friction = friction});
  ElasticMotion motion(body, {weight, plane}, {}, {.step = 0.01});
  ElasticState state = state_at_rest(body);
  for (int i = 0; i < 50; ++i) motion.step(state);
  return (body.mass() * state.velocities).colwise().sum().dot(along.transpose()) / body.mass().sum();
}

/// g (sin - mu cos) t; what touches before the load is full slips a little more.
TEST(Contact, LetsSlideAsFrictionSays) {
  const double cosine = 2.0 / std::sqrt(5.0);
  EXPECT_NEAR(sliding_speed(0.0), 9.81 * 0.5 * cosine * 0.5, 0.01);
  EXPECT_NEAR(sliding_speed(0.2), 9.81 * 0.3 * cosine * 0.5, 0.1);
  EXPECT_NEAR(sliding_speed(0.8), 0.0, 0.1);
}

TEST(Contact, HasNoFrictionInAnEquilibrium) {
  const Mesh mesh = grid(4, 3);
  const Contact contact(test::body_of(mesh), plane_obstacle({0.0, 0.0, 0.1}, {0.0, 0.0, 1.0}), {.friction = 0.5});
  test::Motion motion = test::still_at(mesh.points);
  motion.start.col(0).array() += 0.3;
  EXPECT_NEAR(test::total(test::force_of(contact, motion)).x(), 0.0, 1e-12);
}

/// Where the surface leaves the obstacle there are other places: their number bounds the accuracy.
TEST(Contact, IsTheSameOnTheRefinedBody) {
  for (const Mesh& mesh : {test::quad_ball(), dodecahedron()}) {
    const ElasticSurface body = test::body_of(mesh);
    test::expect_same_when_refined(Contact(body, kFloor, {.intervals = 8}), body, test::still_at(mesh.points), 0.02);
  }
}

TEST(Contact, RefusesWhatMakesNoSense) {
  const Mesh mesh = cube();
  const ElasticSurface body = test::body_of(mesh);
  test::expect_error([&] { Contact(body, {}); }, ErrorCode::BadArgument, "obstacle");
  test::expect_error([&] { Contact(body, kFloor, {.stiffness = -1.0}); }, ErrorCode::BadArgument, "stiffness");
  test::expect_error([&] { Contact(body, kFloor, {.friction = -1.0}); }, ErrorCode::BadArgument, "friction");
  test::expect_error([&] { Contact(body, kFloor, {.thickness = -1.0}); }, ErrorCode::BadArgument, "thickness");
  test::expect_error([&] { Contact(body, kFloor, {.intervals = 0}); }, ErrorCode::BadArgument, "intervals");
  test::expect_error([] { plane_obstacle({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}); }, ErrorCode::BadArgument, "normal");
  test::expect_error([] { sphere_obstacle({0.0, 0.0, 0.0}, 0.0); }, ErrorCode::BadArgument, "radius");
  test::expect_error([] { box_inside_obstacle({0.0, 0.0, 0.0}, {1.0, 0.0, 1.0}); }, ErrorCode::BadArgument, "box");
  const auto act = [&](double distance, double slope) {
    return [&body, &mesh, distance, slope] {
      const Contact contact(body, [=](const Eigen::Vector3d&, Eigen::Vector3d& gradient) {
        gradient = {0.0, 0.0, slope};
        return distance;
      });
      test::sum_of(contact, test::still_at(mesh.points));
    };
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  test::expect_error(act(nan, 1.0), ErrorCode::NotFinite, "the distance of an obstacle from (");
  test::expect_error(act(-1.0, nan), ErrorCode::NotFinite, "the gradient of an obstacle at (");
  test::expect_error(act(-1.0, 0.0), ErrorCode::BadArgument, "the gradient of an obstacle at (");
}

}  // namespace
}  // namespace batten
