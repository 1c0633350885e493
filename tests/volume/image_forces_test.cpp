#include "batten/volume/image_forces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "batten/dynamics/elastic_motion.h"
#include "batten/dynamics/pressure.h"
#include "batten/dynamics/surface_samples.h"
#include "batten/parallel/threads.h"
#include "batten/tessellate/surface_mesh.h"
#include "batten/volume/label_mask.h"
#include "batten/volume/segment_measures.h"
#include "support/errors.h"
#include "support/forces.h"
#include "volume/phantoms.h"

namespace batten {
namespace {

std::shared_ptr<const SplineField> field_of(Volume volume) {
  return std::make_shared<const SplineField>(std::move(volume));
}

/// A ball of the radius without any symmetry.
Mesh ball(double radius) {
  Mesh mesh = test::jittered(test::quad_ball(), 0.05, 3);
  mesh.points *= radius;
  return mesh;
}

/// Values that are no polynomial, on an oblique anisotropic grid.
Volume waves() {
  VolumeGrid grid = test::centred_grid(24);
  grid.axes = Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix() *
              Eigen::Vector3d(0.9, 1.0, 1.2).asDiagonal();
  grid.origin = -grid.axes * Eigen::Vector3d::Constant(11.5);
  return test::made_volume(
      grid, [](const Eigen::Vector3d& at) { return std::sin(0.5 * at[0]) + std::cos(0.4 * at[1] + 0.3 * at[2]); });
}

/// A ball that is bright, blurred by a mm.
Volume bright_ball(double radius) {
  return test::made_volume(test::centred_grid(33), [&](const Eigen::Vector3d& at) {
    return 100.0 / (1.0 + std::exp(2.0 * (at.norm() - radius)));
  });
}

double area_of(const ElasticSurface& body) { return area_places(body, {3, 3}).areas.sum(); }

TEST(SplineField, IsExactForLinearVolumesAndHasItsOwnGradient) {
  const Eigen::Vector3d slope(0.5, -1.0, 2.0);
  VolumeGrid grid = waves().grid;
  const SplineField linear(test::made_volume(grid, [&](const Eigen::Vector3d& at) { return slope.dot(at) + 3.0; }));
  const SplineField wavy(waves());
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector3d at(3.0 * std::sin(i), 3.0 * std::cos(2.0 * i), 3.0 * std::sin(3.0 * i));
    EXPECT_NEAR(linear.at(at).value, slope.dot(at) + 3.0, 1e-5);
    EXPECT_NEAR((linear.at(at).gradient - slope).norm(), 0.0, 1e-5);
    constexpr double kStep = 1e-5;
    for (int c = 0; c < 3; ++c) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(c);
      EXPECT_NEAR((wavy.at(at + step).value - wavy.at(at - step).value) / (2.0 * kStep), wavy.at(at).gradient[c], 1e-6);
    }
  }
  EXPECT_EQ(linear.at(Eigen::Vector3d(1000, 0, 0)).gradient[0], 0.0) << "nothing changes outside";
}

TEST(PotentialForce, IsMinusTheGradientOfItsEnergy) {
  const Mesh mesh = ball(6.0);
  const ElasticSurface body = test::body_of(mesh);
  test::expect_minus_gradient(PotentialForce(body, field_of(waves()), {3.0, {}, {3, 1}}), mesh.points);
}

/// Along a linear potential the guarded force is the strength times the area, but for the guard.
TEST(PotentialForce, HasThePapersLengthWhereverTheGradientIsLarge) {
  const Mesh mesh = ball(6.0);
  const ElasticSurface body = test::body_of(mesh);
  const Eigen::Vector3d way = Eigen::Vector3d(1.0, 2.0, -2.0).normalized();
  for (const double steep : {1e-3, 1.0, 1e3}) {
    const auto field = field_of(
        test::made_volume(test::centred_grid(25), [&](const Eigen::Vector3d& at) { return steep * way.dot(at); }));
    const Points forces = test::force_of(PotentialForce(body, field, {2.0, 1.0, {3, 3}}), test::still_at(mesh.points));
    const double expected = 2.0 * area_of(body) * steep / std::hypot(steep, 1.0);
    EXPECT_NEAR((test::total(forces) - expected * way).norm(), 0.0, 1e-3 * expected) << steep;
  }
  test::expect_error(
      [&] {
        PotentialForce(body, field_of(waves()), {1.0, 0.0, {3, 1}});
      },
      ErrorCode::BadArgument, "guard");
}

TEST(EdgeSprings, DrawABallToABallsEdge) {
  constexpr double kRadius = 9.0;
  constexpr double kWidth = 1.0;
  const auto search = std::make_shared<const EdgeSearch>(bright_ball(kRadius), kWidth);
  Mesh mesh = test::quad_ball();
  mesh.points *= 8.0;
  const ElasticSurface body = test::body_of(mesh);
  const EdgeSprings springs(body, search, {5.0, 3.0, {2, 0}});
  const ForceSum sum = test::sum_of(springs, test::still_at(mesh.points));
  const Points points = sum.springs.at(0).rows->rows * mesh.points;
  double energy = 0.0;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const double found = sum.springs[0].targets.row(i).norm();
    EXPECT_NEAR(found, kRadius, 0.25) << "the edge, but for what blur does to it";
    energy += 0.5 * sum.springs[0].stiffness[i] * std::pow(found - points.row(i).norm(), 2.0);
  }
  EXPECT_NEAR(sum.energy, energy, 0.02 * energy) << "normals of the ball are those of a sphere, nearly";
  const Points forces = test::force_of(springs, test::still_at(mesh.points));
  for (Eigen::Index v = 0; v < forces.rows(); ++v) EXPECT_GT(forces.row(v).dot(mesh.points.row(v)), 0.0) << "outwards";
  EXPECT_LE(sum.springs[0].stiffness.sum(), 5.0 * area_of(body) * 1.001) << "weights are 1 at most";
}

TEST(MaskSprings, AreMinusTheGradientOfTheirEnergy) {
  const Volume mask = label_mask(test::made_volume(test::centred_grid(25), test::bean), {});
  const auto distance = field_of(signed_distance(mask));
  const Mesh mesh = ball(6.5);
  test::expect_minus_gradient(MaskSprings(test::body_of(mesh), distance, {2.0, {2, 0}}), mesh.points, 1e-5);
}

TEST(SignedDistance, IsThatOfABall) {
  constexpr double kRadius = 8.0;
  const Volume image =
      test::made_volume(test::centred_grid(25), [](const Eigen::Vector3d& at) { return at.norm() < kRadius ? 1 : 0; });
  const Volume distance = signed_distance(label_mask(image, {}));
  for (Index k = 0; k < distance.grid.size[2]; ++k) {
    for (Index j = 0; j < distance.grid.size[1]; ++j) {
      for (Index i = 0; i < distance.grid.size[0]; ++i) {
        const double exact = distance.grid.to_world(Eigen::Vector3d(i, j, k)).norm() - kRadius;
        EXPECT_NEAR(distance.at(i, j, k), exact, 1.0);
      }
    }
  }
  test::expect_error([] { signed_distance(test::made_volume(test::centred_grid(5), [](const auto&) { return 0.0; })); },
                     ErrorCode::BadArgument, "inside and outside");
}

/// Where the number is the inside's mean everywhere, it is a pressure.
TEST(RegionForce, IsAPressureWhereTheNumbersAreTheInsides) {
  const Mesh mesh = ball(6.0);
  const ElasticSurface body = test::body_of(mesh);
  const auto image = field_of(test::made_volume(test::centred_grid(25), [](const auto&) { return 7.0; }));
  PressureOptions pressure{always(3.0), {}, 0.0, {5, 12}};
  const Points expected = test::force_of(Pressure(body, pressure), test::still_at(mesh.points));
  const Points grown =
      test::force_of(RegionForce(body, image, {7.0, 2.0}, {3.0, {5, 12}}), test::still_at(mesh.points));
  EXPECT_NEAR((grown - expected).norm(), 0.0, 1e-3 * expected.norm());
  const Points shrunk =
      test::force_of(RegionForce(body, image, {2.0, 7.0}, {3.0, {5, 12}}), test::still_at(mesh.points));
  EXPECT_NEAR((shrunk + expected).norm(), 0.0, 1e-3 * expected.norm());
}

/// With I = x / 100 and means of 1 and -1 the force is minus the gradient of -k times the integral of x / 100 over the
/// inside: moved along x, that falls by k V / 100; in general it is a surface integral of x^2 / 2.
TEST(RegionForce, IsMinusTheGradientOfTheRegionsEnergy) {
  constexpr double kStrength = 4.0;
  const Mesh mesh = ball(6.0);
  const ElasticSurface body = test::body_of(mesh);
  const auto image =
      field_of(test::made_volume(test::centred_grid(33), [](const Eigen::Vector3d& at) { return at[0] / 100.0; }));
  const RegionForce force(body, image, {1.0, -1.0}, {kStrength, {5, 12}});
  const Points forces = test::force_of(force, test::still_at(mesh.points));
  const double volume = Pressure(body, 1.0).volume(mesh.points);
  EXPECT_NEAR((test::total(forces) - Eigen::Vector3d(kStrength * volume / 100.0, 0, 0)).norm(), 0.0,
              1e-3 * kStrength * volume / 100.0);
  const SurfaceSamples samples(body.patches(), GaussSamples{{6, 12}});
  const auto energy = [&](const Points& positions) {
    const Points jets = samples.evaluate(positions);
    double sum = 0.0;
    for (std::ptrdiff_t i = 0; i < samples.count(); ++i) {
      const Eigen::Vector3d cross = Eigen::Vector3d(jets.row(3 * i + 1)).cross(Eigen::Vector3d(jets.row(3 * i + 2)));
      sum -= kStrength / 100.0 * samples.weight(i) * 0.5 * jets(3 * i, 0) * jets(3 * i, 0) * cross[0];
    }
    return sum;
  };
  const Points way = test::random_values(static_cast<Index>(mesh.points.rows()), 3);
  constexpr double kStep = 1e-4;
  const double slope = (energy(mesh.points + kStep * way) - energy(mesh.points - kStep * way)) / (2.0 * kStep);
  EXPECT_NEAR(slope, -forces.cwiseProduct(way).sum(), 1e-3 * forces.norm() * way.norm());
}

TEST(RegionMeans, AreThoseInsideAndOutside) {
  const Volume image =
      test::made_volume(test::centred_grid(33), [](const Eigen::Vector3d& at) { return at.norm() < 9.0 ? 5.0 : 2.0; });
  Mesh mesh = test::quad_ball();
  mesh.points *= 8.0;
  const Mesh fine = surface_of_faces(Topology(mesh), Scheme{}, mesh, 5000);
  const RegionMeans means = region_means(image, fine, 4);
  EXPECT_NEAR(means.inside, 5.0, 1e-6);
  EXPECT_GT(means.outside, 2.0);
  EXPECT_LT(means.outside, 3.0);
}

/// Small, in the middle: pressure alone would blow it up; at the edge the springs hold it. They count by the rest
/// shape's area, the pressure by the surface's own: where both balance the surface lies (R / r)^2 p / k outside of the
/// edge, less what its elasticity draws it back.
TEST(ImageForces, ASmallSphereInflatesUntilTheEdgeHoldsIt) {
  constexpr double kRadius = 9.0;
  constexpr double kSmall = 4.0;
  constexpr double kPressure = 2.0;
  constexpr double kStiffness = 100.0;
  Mesh mesh = test::quad_ball();
  mesh.points *= kSmall;
  ElasticOptions elastic;
  elastic.material = {{0.0}, {1.0}, {0.5}, {0.5}};
  const ElasticSurface body(Topology(mesh), Scheme{}, mesh.points, elastic);
  const auto search = std::make_shared<const EdgeSearch>(bright_ball(kRadius), 1.0);
  MotionOptions options;
  options.scheme = TimeScheme::MassFree;
  options.step = 0.1;
  ElasticMotion motion(body,
                       {std::make_shared<Pressure>(body, kPressure),
                        std::make_shared<EdgeSprings>(body, search, EdgeSpringOptions{kStiffness, 2.0, {2, 0}})},
                       {}, options);
  ElasticState state = state_at_rest(body);
  for (int i = 0; i < 150; ++i) motion.step(state);
  EXPECT_LT(motion.measure(state).residual_force, 1e-3) << "it is at rest";
  Mesh moved = mesh;
  moved.points = state.positions;
  const Scalars radii = surface_of_faces(Topology(moved), Scheme{}, moved, 5000).points.rowwise().norm();
  EXPECT_LT(radii.maxCoeff() - radii.minCoeff(), 0.3);
  EXPECT_NEAR(radii.mean(), kRadius + std::pow(kRadius / kSmall, 2.0) * kPressure / kStiffness, 0.2);
}

TEST(ImageForces, HaveTheSameBitsForAnyNumberOfThreads) {
  const Mesh mesh = ball(7.0);
  const ElasticSurface body = test::body_of(mesh);
  const auto waving = field_of(waves());
  const auto search = std::make_shared<const EdgeSearch>(bright_ball(9.0), 1.0);
  const std::vector<std::shared_ptr<const Force>> forces{
      std::make_shared<PotentialForce>(body, waving),
      std::make_shared<RegionForce>(body, waving, RegionMeans{1.0, 0.0}), std::make_shared<EdgeSprings>(body, search),
      std::make_shared<MaskSprings>(body, waving)};
  for (const auto& force : forces) {
    const auto with = [&](int threads) {
      const ThreadLimit limit(threads);
      return test::force_of(*force, test::still_at(mesh.points));
    };
    EXPECT_EQ(with(1), with(2)) << force->name();
  }
}

TEST(ImageForces, AreTheSameOnTheRefinedBody) {
  const Mesh mesh = ball(6.0);
  const ElasticSurface body = test::body_of(mesh);
  const test::Motion still = test::still_at(mesh.points);
  test::expect_same_when_refined(PotentialForce(body, field_of(waves()), {1.0, 0.1, {5, 3}}), body, still, 5e-3);
  test::expect_same_when_refined(RegionForce(body, field_of(waves()), {1.0, -1.0}, {1.0, {5, 3}}), body, still, 5e-3);
  const Volume mask = label_mask(test::made_volume(test::centred_grid(25), test::bean), {});
  test::expect_same_when_refined(MaskSprings(body, field_of(signed_distance(mask)), {1.0, {4, 3}}), body, still, 5e-3);
}

}  // namespace
}  // namespace batten
