#include "batten/mesh/discrete_curvature.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "batten/error.h"
#include "batten/mesh/primitives.h"
#include "batten/refine/refinement.h"
#include "support/shapes.h"

namespace batten {
namespace {

constexpr double kPi = std::numbers::pi;

Fairness measure(const Topology& topology, ConstValuesRef points) {
  return fairness(topology, points, discrete_curvature(topology, points));
}
Fairness measure(const Mesh& mesh) { return measure(Topology(mesh), mesh.points); }

/// A regular solid refined and moved out onto the sphere around it.
RefinedSurface sphere(const Mesh& solid, int levels, double radius) {
  RefinedSurface surface = refine(Topology(solid), choose_scheme(solid), solid.points, levels);
  surface.values = radius * surface.values.rowwise().normalized();
  return surface;
}

TEST(DiscreteCurvature, SphereBendsByFourPiWhateverItsRadius) {
  for (const double radius : {1.0, 250.0}) {
    double before = 0.0;
    for (int levels = 2; levels <= 4; ++levels) {
      const RefinedSurface surface = sphere(icosahedron(), levels, radius);
      const Fairness found = measure(surface.topology, surface.values);
      const double error = std::abs(found.bending - 4.0 * kPi);
      EXPECT_LT(error, 4.0 * kPi * std::pow(0.25, levels));
      if (before > 0.0) {
        EXPECT_NEAR(before / error, 4.0, 0.5);  // second order
      }
      EXPECT_NEAR(found.area, 4.0 * kPi * radius * radius, found.area * std::pow(0.25, levels));
      EXPECT_EQ(found.left_out, 0);
      before = error;
    }
  }
}

/// At a vertex of valence 3 too, where the mixed area would say twice as much.
TEST(DiscreteCurvature, SphereHasItsCurvatureAtVerticesOfEveryValence) {
  for (const Mesh& solid : {tetrahedron(), octahedron(), icosahedron()}) {
    const RefinedSurface surface = sphere(solid, 5, 2.0);
    const DiscreteCurvature found = discrete_curvature(surface.topology, surface.values);
    for (Index v = 0; v < solid.vertex_count(); ++v) EXPECT_NEAR(found.mean[v], 0.5, 2e-3);
  }
}

TEST(DiscreteCurvature, InsideOutHasTheOtherSign) {
  RefinedSurface surface = sphere(icosahedron(), 3, 2.0);
  surface.values = -surface.values;
  const DiscreteCurvature found = discrete_curvature(surface.topology, surface.values);
  EXPECT_LT(found.mean.maxCoeff(), -0.49);
}

/// W = pi^2 c^2 / sqrt(c^2 - 1) for c = R / r, and 2 pi^4 R^3 / (R^2 - r^2)^(3/2), both by integration of
/// H = (R + 2 r cos t) / (2 r (R + r cos t)).
TEST(DiscreteCurvature, TorusConvergesToItsClosedForms) {
  const double ratio = 2.5;
  const double bending = kPi * kPi * ratio * ratio / std::sqrt(ratio * ratio - 1.0);
  const double variation = 2.0 * std::pow(kPi, 4) * std::pow(1.0 / (1.0 - 0.16), 1.5);
  for (const bool triangles : {false, true}) {
    double bending_before = 0.0;
    double variation_before = 0.0;
    for (const Index n : {30, 60, 120}) {
      const Fairness found = measure(triangles ? test::triangle_torus(2 * n, n) : torus(2 * n, n));
      const double bending_error = std::abs(found.bending - bending);
      const double variation_error = std::abs(found.variation - variation);
      if (n > 30) {
        EXPECT_NEAR(bending_before / bending_error, 4.0, 0.6) << n;
        EXPECT_NEAR(variation_before / variation_error, 4.0, 0.6) << n;
      }
      bending_before = bending_error;
      variation_before = variation_error;
    }
    EXPECT_LT(bending_before, 2e-3 * bending);
    EXPECT_LT(variation_before, 1e-2 * variation);
  }
}

TEST(DiscreteCurvature, AreasCoverTheMeshOnce) {
  for (const test::NamedMesh& sample : test::sample_meshes()) {
    const Topology topology(sample.mesh);
    const DiscreteCurvature found = discrete_curvature(topology, sample.mesh.points);
    const Fairness sums = fairness(topology, sample.mesh.points, found);
    EXPECT_NEAR(found.area.sum(), sums.area, 1e-12 * sums.area) << sample.name;
    EXPECT_GE(found.area.minCoeff(), 0.0) << sample.name;
  }
}

TEST(DiscreteCurvature, LeavesOutBoundariesCreasesAndCorners) {
  Mesh mesh = grid(6, 6);
  mesh.creases = {{16, 17, 10.0}, {17, 18, 0.5}};
  mesh.corners = {{24, 1.0}};
  const DiscreteCurvature found = discrete_curvature(Topology(mesh), mesh.points);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const bool rim = v < 7 || v >= 42 || v % 7 == 0 || v % 7 == 6;
    const bool tagged = v == 16 || v == 17 || v == 18 || v == 24;
    EXPECT_EQ(std::isnan(found.mean[v]), rim || tagged) << v;
    if (!rim && !tagged) {
      EXPECT_NEAR(found.mean[v], 0.0, 1e-14);
    }
  }
  const Fairness sums = measure(mesh);
  EXPECT_EQ(sums.left_out, 24 + 4);
  EXPECT_NEAR(sums.area, 4.0, 1e-14);
}

TEST(DiscreteCurvature, LeavesOutTheRimWhereNothingIsTagged) {
  const Mesh mesh = grid(4, 4);
  const DiscreteCurvature found = discrete_curvature(Topology(mesh), mesh.points);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const bool rim = v < 5 || v >= 20 || v % 5 == 0 || v % 5 == 4;
    EXPECT_EQ(std::isnan(found.mean[v]), rim) << v;
  }
}

TEST(DiscreteCurvature, WantsFinitePointsOfThreeColumns) {
  const Mesh mesh = icosahedron();
  const Topology topology(mesh);
  EXPECT_THROW(discrete_curvature(topology, mesh.points.leftCols(2)), Error);
  EXPECT_THROW(discrete_curvature(topology, mesh.points.topRows(3)), Error);
  Values points = mesh.points;
  points(3, 1) = std::nan("");
  EXPECT_THROW(discrete_curvature(topology, points), Error);
}

}  // namespace
}  // namespace batten
