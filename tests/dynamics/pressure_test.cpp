#include "batten/dynamics/pressure.h"

#include <gtest/gtest.h>

#include <limits>

#include "batten/dynamics/surface_samples.h"
#include "batten/parallel/threads.h"
#include "batten/tessellate/tessellator.h"
#include "support/errors.h"
#include "support/forces.h"
#include "support/tessellation.h"

namespace batten {
namespace {

/// Of tetrahedra between the origin and triangles of the surface's tessellation.
double tessellated_volume(const ElasticSurface& body, const Points& control, int levels) {
  const Tessellation<double> mesh =
      tessellate<double>(body.topology(), body.patches().scheme(), control, levels, {true});
  const auto point = [&](Index v) { return Eigen::Vector3d(&mesh.points[3 * static_cast<std::size_t>(v)]); };
  double sum = 0.0;
  for (std::size_t f = 0; f < mesh.faces.size(); f += static_cast<std::size_t>(mesh.face_size)) {
    for (Index k = 2; k < mesh.face_size; ++k) {
      sum += point(mesh.faces[f]).dot(point(mesh.faces[f + k - 1]).cross(point(mesh.faces[f + k]))) / 6.0;
    }
  }
  return sum;
}

std::vector<std::pair<Mesh, Scheme>> closed_surfaces() {
  return {{test::jittered(test::quad_ball(), 0.1, 3), Scheme{}},
          {test::jittered(dodecahedron(), 0.1, 3), Scheme{}},
          {test::jittered(icosahedron(), 0.1, 3), Scheme{SchemeKind::Loop}},
          {torus(8, 6), Scheme{}}};
}

PressureOptions held(double volume) { return {always(0.5), always(volume), 20.0, {3, 3}}; }

/// The tessellation's error falls by four a level: two of them leave that of the fourth order, 16^-levels.
TEST(Pressure, VolumeIsThatOfFineMeshes) {
  for (const auto& [mesh, scheme] : closed_surfaces()) {
    const ElasticSurface body = test::body_of(mesh, scheme);
    const double fine = tessellated_volume(body, mesh.points, 6);
    const double volume = fine + (fine - tessellated_volume(body, mesh.points, 5)) / 3.0;
    PressureOptions options = held(1.0);
    options.quadrature = {5, 8};
    EXPECT_NEAR(Pressure(body, options).volume(mesh.points), volume, 1e-5 * volume);
    EXPECT_NEAR(Pressure(body, 1.0).volume(mesh.points), volume, 1e-4 * volume);
  }
}

TEST(Pressure, ForceIsMinusTheGradientOfTheEnergy) {
  for (const auto& [mesh, scheme] : closed_surfaces()) {
    const ElasticSurface body = test::body_of(mesh, scheme);
    test::expect_minus_gradient(Pressure(body, 3.0), mesh.points);
    test::expect_minus_gradient(Pressure(body, held(1.5)), mesh.points);
  }
}

TEST(Pressure, OfAClosedSurfaceNeitherPushesNorTurnsIt) {
  for (const auto& [mesh, scheme] : closed_surfaces()) {
    Points points = mesh.points;
    points.rowwise() += Eigen::RowVector3d(5.0, -2.0, 1.0);
    const Points forces = test::force_of(Pressure(test::body_of(mesh, scheme), 3.0), test::still_at(points));
    EXPECT_GT(forces.cwiseAbs().sum(), 1.0);
    EXPECT_NEAR(test::total(forces).norm(), 0.0, 1e-12 * forces.cwiseAbs().sum());
    EXPECT_NEAR(test::torque(points, forces).norm(), 0.0, 1e-11 * forces.cwiseAbs().sum());
  }
}

/// On a flat square of area 4 whose boundary stands still.
TEST(Pressure, OfAnOpenSurfaceIsPressureTimesArea) {
  const Mesh mesh = grid(6, 5);
  const ElasticSurface body = test::square_of(mesh);
  const Pressure pressure(body, 2.5);
  EXPECT_FALSE(pressure.is_closed());
  const Points forces = test::force_of(pressure, test::still_at(mesh.points));
  EXPECT_NEAR((test::total(forces) - Eigen::Vector3d(0.0, 0.0, 10.0)).norm(), 0.0, 1e-12);
  EXPECT_EQ(test::sum_of(pressure, test::still_at(mesh.points)).energy, 0.0);
}

/// Both forms of the force are integrals of the same on a closed surface; an open one has the second.
TEST(Pressure, PushesAlongTheNormals) {
  const Mesh mesh = test::quad_ball();
  const ElasticSurface body = test::body_of(mesh);
  const SurfaceSamples samples(body.patches(), GaussSamples{{5, 12}});
  const Points jets = samples.evaluate(mesh.points);
  Points normals(samples.count(), 3);
  for (std::ptrdiff_t i = 0; i < samples.count(); ++i) {
    normals.row(i) = samples.weight(i) * jets.row(3 * i + 1).cross(jets.row(3 * i + 2));
  }
  const Points expected = 3.0 * samples.pull_back(normals);
  const Points forces = test::force_of(Pressure(body, 3.0), test::still_at(mesh.points));
  EXPECT_NEAR((forces - expected).norm(), 0.0, 1e-3 * expected.norm());
}

TEST(Pressure, OfAHeldVolumeIsStiffAlongItsGradient) {
  const Mesh mesh = test::quad_ball();
  const Pressure pressure(test::body_of(mesh), held(1.5));
  const ForceSum sum = test::sum_of(pressure, test::still_at(mesh.points));
  ASSERT_EQ(sum.along.size(), 1U);
  EXPECT_NEAR(sum.along[0].stiffness, 20.0 / 1.5, 1e-14);
  EXPECT_NEAR((sum.along[0].direction - pressure.volume_gradient(mesh.points)).norm(), 0.0, 1e-14);
  const double expected = 0.5 + 20.0 * (1.0 - pressure.volume(mesh.points) / 1.5);
  EXPECT_NEAR((sum.force - expected * sum.along[0].direction).norm(), 0.0, 1e-13);
}

TEST(Pressure, IsTheSameOnTheRefinedBody) {
  const Mesh mesh = grid(4, 3);
  const ElasticSurface sheet = test::body_of(mesh);
  test::expect_same_when_refined(Pressure(sheet, 2.0), sheet, test::still_at(test::jittered(mesh, 0.1, 5).points),
                                 1e-4);
  for (const auto& [closed, scheme] : closed_surfaces()) {
    const ElasticSurface body = test::body_of(closed, scheme);
    const Refinement refinement(body.topology(), scheme);
    const auto finer = Pressure(body, 2.0).refined(body, body.refined());
    const double energy = test::sum_of(Pressure(body, 2.0), test::still_at(closed.points)).energy;
    const Points points = refinement.apply(closed.points);
    EXPECT_NEAR(test::sum_of(*finer, test::still_at(points)).energy, energy, 1e-4 * std::abs(energy));
  }
}

TEST(Pressure, HasTheSameBitsForAnyNumberOfThreads) {
  const Mesh mesh = torus(40, 20);
  const Pressure pressure(test::body_of(mesh), held(1.5));
  const auto forces = [&](int threads) {
    const ThreadLimit limit(threads);
    return test::force_of(pressure, test::still_at(mesh.points));
  };
  EXPECT_EQ(forces(1), forces(2));
}

TEST(Pressure, RefusesWhatMakesNoSense) {
  const ElasticSurface sheet = test::body_of(grid(2, 2));
  const ElasticSurface body = test::body_of(cube());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  test::expect_error([&] { Pressure(sheet, held(1.0)); }, ErrorCode::BadArgument, "open");
  test::expect_error([&] { Pressure(body, PressureOptions{}); }, ErrorCode::BadArgument, "a pressure or a volume");
  test::expect_error([&] { Pressure(body, nan); }, ErrorCode::NotFinite, "pressure");
  PressureOptions weak = held(1.0);
  weak.bulk_modulus = -1.0;
  test::expect_error([&] { Pressure(body, weak); }, ErrorCode::BadArgument, "bulk modulus");
  const test::Motion motion = test::still_at(cube().points);
  test::expect_error([&] { test::sum_of(Pressure(body, held(0.0)), motion); }, ErrorCode::BadArgument, "volume");
  test::expect_error([&] { test::sum_of(Pressure(body, held(nan)), motion); }, ErrorCode::NotFinite, "volume");
}

}  // namespace
}  // namespace batten
