#include "batten/energy/regular_energies.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "batten/patch/spline_jet.h"
#include "batten/surface/quadrature.h"
#include "support/shapes.h"

namespace batten {
namespace {

/// By Gauss's rule, which is exact for products of two of the splines.
Eigen::MatrixXd integrals(bool quads, EnergyKind kind) {
  const Mesh mesh = quads ? torus(5, 5) : test::triangle_torus(5, 5);
  const Scheme scheme{quads ? SchemeKind::CatmullClark : SchemeKind::Loop};
  const SurfaceQuadrature quadrature = surface_quadrature(SurfacePatches(Topology(mesh), scheme), {5, 0});
  const int size = patch_size(quads);
  Eigen::Matrix2d metric = Eigen::Matrix2d::Identity();
  if (!quads) metric << 1.0, -0.5, -0.5, 1.0;
  if (!quads) metric *= 2.0 / std::sqrt(3.0);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(size, size);
  JetWeights jet;
  for (std::size_t q = 0; q < quadrature.starts[1]; ++q) {
    jet_weights(quads, quadrature.places[q].u, quadrature.places[q].v, jet);
    const auto gradient = [&](int i) { return Eigen::Vector2d(jet.du[i], jet.dv[i]); };
    const auto second = [&](int i) {
      Eigen::Matrix2d matrix;
      matrix << jet.duu[i], jet.duv[i], jet.duv[i], jet.dvv[i];
      return matrix;
    };
    for (int i = 0; i < size; ++i) {
      for (int k = 0; k < size; ++k) {
        sum(i, k) += quadrature.weights[q] * (kind == EnergyKind::Mass ? jet.value[i] * jet.value[k]
                                              : kind == EnergyKind::Membrane
                                                  ? gradient(i).dot(metric * gradient(k))
                                                  : (metric * second(i) * metric * second(k)).trace());
      }
    }
  }
  return sum;
}

TEST(RegularEnergies, AreTheIntegralsOfTheSplines) {
  for (const bool quads : {true, false}) {
    for (const EnergyKind kind : {EnergyKind::Mass, EnergyKind::Membrane, EnergyKind::ThinPlate}) {
      const Eigen::MatrixXd exact = regular_energy(quads, kind);
      EXPECT_LE((exact - integrals(quads, kind)).cwiseAbs().maxCoeff(), 4e-15 * exact.cwiseAbs().maxCoeff())
          << quads << static_cast<int>(kind);
      EXPECT_EQ(exact, exact.transpose());
    }
  }
}

/// Integrals of products of the B-spline functions are rational: entries as fractions, worked out by hand.
TEST(RegularEnergies, CornersOfTheMatricesAreTheseFractions) {
  EXPECT_DOUBLE_EQ(regular_energy(true, EnergyKind::Mass)(0, 0), 1.0 / (252.0 * 252.0));
  EXPECT_DOUBLE_EQ(regular_energy(true, EnergyKind::Membrane)(0, 0), 2.0 / (20.0 * 252.0));
  EXPECT_DOUBLE_EQ(regular_energy(true, EnergyKind::ThinPlate)(0, 0), 2.0 / (3.0 * 252.0) + 2.0 / 400.0);
  EXPECT_DOUBLE_EQ(regular_energy(true, EnergyKind::Mass)(5, 10), 933.0 * 933.0 / (5040.0 * 5040.0));
  EXPECT_DOUBLE_EQ(regular_energy(false, EnergyKind::Mass)(3, 11), 1.0 / 362880.0);  // 1 / 9!
}

/// A face is the sum of its children.
TEST(RegularEnergies, TurningAFaceChangesNothing) {
  // Where each point goes when the first corner becomes the second.
  static constexpr int kTriangle[12] = {1, 2, 0, 7, 9, 11, 5, 10, 4, 8, 3, 6};
  for (const EnergyKind kind : {EnergyKind::Mass, EnergyKind::Membrane, EnergyKind::ThinPlate}) {
    const Eigen::MatrixXd quad = regular_energy(true, kind);
    const Eigen::MatrixXd triangle = regular_energy(false, kind);
    for (int i = 0; i < 16; ++i) {
      for (int k = 0; k < 16; ++k) {
        const auto turned = [](int p) { return 4 * (p % 4) + 3 - p / 4; };
        EXPECT_NEAR(quad(turned(i), turned(k)), quad(i, k), 1e-16);
        if (i < 12 && k < 12) {
          EXPECT_EQ(triangle(kTriangle[i], kTriangle[k]), triangle(i, k)) << i << " " << k;
        }
      }
    }
  }
}

}  // namespace
}  // namespace batten
