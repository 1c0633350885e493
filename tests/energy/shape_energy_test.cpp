#include "batten/energy/shape_energy.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "batten/interpolate/interpolator.h"
#include "batten/mesh/primitives.h"
#include "batten/surface/limit_surface.h"
#include "batten/surface/quadrature.h"
#include "support/dense.h"
#include "support/errors.h"
#include "support/schemes.h"
#include "support/shapes.h"

namespace batten {
namespace {

constexpr ShapeEnergyKind kShapeKinds[] = {ShapeEnergyKind::Stretch, ShapeEnergyKind::Bending,
                                           ShapeEnergyKind::Variation};
constexpr double kPi = std::numbers::pi;

double quadratic(const ShapeEnergy::Matrix& matrix, const Values& values) {
  return (values.transpose() * (matrix * values)).trace();
}

struct Sample {
  SurfacePatches patches;
  Values points;
};

/// Regular and irregular, closed and open, of quads and of triangles, with a crease.
std::vector<Sample> samples() {
  Mesh creased = test::jittered(grid(5, 4), 0.1, 2);
  creased.creases.push_back({7, 8, 10.0});
  creased.creases.push_back({8, 9, 10.0});
  std::vector<Sample> all;
  for (const Mesh& mesh : {test::jittered(torus(6, 5), 0.05, 1), creased, cube()}) {
    all.push_back({SurfacePatches(Topology(mesh), test::kCatmullClark), mesh.points});
  }
  for (const Mesh& mesh : {test::triangle_torus(6, 5), icosahedron(), test::bipyramid(9)}) {
    all.push_back({SurfacePatches(Topology(mesh), test::kLoop), mesh.points});
  }
  return all;
}

TEST(ShapeEnergy, AddsUpTheCurvaturesOfItsOwnReference) {
  for (const Sample& sample : samples()) {
    const LimitSurface surface(sample.patches, sample.points);
    const SurfaceQuadrature quadrature = surface_quadrature(sample.patches, kShapeQuadrature);
    const Scalars weights = area_weights(surface, quadrature);
    double bending = 0.0;
    for (Eigen::Index i = 0; i < weights.size(); ++i) {
      const PointCurvature at = curvature_of(surface.jet(quadrature.places[i]));
      bending += weights[i] * (at.greatest * at.greatest + at.least * at.least);
    }
    EXPECT_NEAR(ShapeEnergy(sample.patches, ShapeEnergyKind::Stretch).energy(sample.points), 2.0 * weights.sum(),
                1e-11 * weights.sum());
    EXPECT_NEAR(ShapeEnergy(sample.patches, ShapeEnergyKind::Bending).energy(sample.points), bending, 1e-9 * bending);
  }
}

TEST(ShapeEnergy, IsTheQuadraticFormOfItsMatrix) {
  for (const Sample& sample : samples()) {
    for (const ShapeEnergyKind kind : kShapeKinds) {
      const ShapeEnergy energy(sample.patches, kind);
      const double expected = energy.energy(sample.points);
      EXPECT_NEAR(quadratic(energy.matrix(sample.points), sample.points), expected, 1e-8 * expected);
    }
  }
}

TEST(ShapeEnergy, HasASymmetricPositiveMatrixThatDoesNotSeeConstants) {
  for (const Sample& sample : samples()) {
    for (const ShapeEnergyKind kind : kShapeKinds) {
      const Eigen::MatrixXd matrix = ShapeEnergy(sample.patches, kind).matrix(sample.points);
      const Eigen::VectorXd eigenvalues = test::symmetric_modes(matrix).values;
      const double largest = eigenvalues.tail(1)[0];
      EXPECT_EQ(matrix, matrix.transpose());
      EXPECT_GE(eigenvalues[0], -1e-13 * largest);
      // Rows are sums of some hundred numbers.
      EXPECT_LT(matrix.rowwise().sum().cwiseAbs().maxCoeff(), 1e-13 * largest);
    }
  }
}

/// A motion changes neither lengths nor the energy of what moves along.
TEST(ShapeEnergy, DoesNotChangeUnderMotions) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (const Sample& sample : samples()) {
    Values moved = sample.points * turn.transpose();
    moved.rowwise() += Eigen::RowVector3d(3, -1, 2);
    for (const ShapeEnergyKind kind : kShapeKinds) {
      const ShapeEnergy energy(sample.patches, kind);
      const Eigen::MatrixXd before = energy.matrix(sample.points);
      EXPECT_LT((Eigen::MatrixXd(energy.matrix(moved)) - before).norm(), 1e-11 * before.norm());
    }
  }
}

/// Of polynomials over a plane the derivatives are known, whatever the faces: a grid whose surface is z = 0.
TEST(ShapeEnergy, IsExactOverAPlane) {
  Mesh mesh = test::jittered(grid(6, 6), 0.15, 3);
  mesh.points.col(2).setZero();
  const SurfacePatches patches(Topology(mesh), test::kCatmullClark);
  const double area = 0.5 * ShapeEnergy(patches, ShapeEnergyKind::Stretch).energy(mesh.points);
  Values heights = mesh.points.leftCols(2) * Eigen::Vector2d(3.0, -4.0);
  EXPECT_NEAR(quadratic(ShapeEnergy(patches, ShapeEnergyKind::Stretch).matrix(mesh.points), heights), 25.0 * area,
              1e-10 * area);
  for (const ShapeEnergyKind kind : {ShapeEnergyKind::Bending, ShapeEnergyKind::Variation}) {
    const ShapeEnergy::Matrix matrix = ShapeEnergy(patches, kind).matrix(mesh.points);
    EXPECT_NEAR(quadratic(matrix, heights), 0.0, 1e-12 * matrix.norm());
  }
}

/// The torus of radii R and r: k1 = 1/r, k2 = cos a/(R + r cos a).
struct TorusEnergies {
  double bending = 0.0;
  double variation = 0.0;
};
TorusEnergies torus_energies(double large, double small) {
  TorusEnergies sums;
  constexpr int kSteps = 400;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = 2.0 * kPi * i / kSteps;
    const double radius = large + small * std::cos(angle);
    const double area = 2.0 * kPi * radius * small * 2.0 * kPi / kSteps;
    const double across = std::cos(angle) / radius;
    const double slope = large * std::sin(angle) / (small * radius * radius);
    sums.bending += area * (1.0 / (small * small) + across * across);
    sums.variation += area * 3.0 * slope * slope;
  }
  return sums;
}

/// Of the surface through points of a torus. The curvature of a bicubic spline is exact to second order.
TorusEnergies interpolated_energies(const Mesh& mesh, const Scheme& scheme) {
  const Topology topology(mesh);
  const Values control = Interpolator(topology, scheme).solve(mesh.points).control;
  const SurfacePatches patches(topology, scheme);
  return {ShapeEnergy(patches, ShapeEnergyKind::Bending).energy(control),
          ShapeEnergy(patches, ShapeEnergyKind::Variation).energy(control)};
}

TEST(ShapeEnergy, ComesToTheIntegralsOfATorus) {
  const TorusEnergies exact = torus_energies(1.0, 0.4);
  const auto expect_order = [&](auto make, const Scheme& scheme) {
    const TorusEnergies coarse = interpolated_energies(make(24, 12), scheme);
    const TorusEnergies fine = interpolated_energies(make(48, 24), scheme);
    EXPECT_NEAR(fine.bending, exact.bending, 2e-3 * exact.bending);
    EXPECT_NEAR(fine.variation, exact.variation, 0.05 * exact.variation);
    EXPECT_LT(std::abs(fine.bending - exact.bending), 0.3 * std::abs(coarse.bending - exact.bending));
    EXPECT_LT(std::abs(fine.variation - exact.variation), 0.4 * std::abs(coarse.variation - exact.variation));
  };
  expect_order([](Index a, Index b) { return torus(a, b); }, test::kCatmullClark);
  expect_order([](Index a, Index b) { return test::triangle_torus(a, b); }, test::kLoop);
}

}  // namespace
}  // namespace batten
