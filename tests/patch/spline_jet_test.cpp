/// Regular patches: values by subdivision, derivatives as a polynomial's.
#include "batten/patch/spline_jet.h"

#include <gtest/gtest.h>

#include "batten/tessellate/tile_weights.h"

namespace batten {
namespace {

constexpr int kSteps = 8;

TEST(TriangleJet, HasTheWeightsOfSubdivision) {
  const Buffer<double> expected = triangle_weights(kSteps, TileValue::Limit);
  std::size_t next = 0;
  for (int j = 0; j <= kSteps; ++j) {
    for (int i = 0; i + j <= kSteps; ++i) {
      JetWeights weights;
      triangle_jet_weights(static_cast<double>(i) / kSteps, static_cast<double>(j) / kSteps, weights);
      for (int k = 0; k < kTrianglePatchSize; ++k) ASSERT_NEAR(weights.value[k], expected[next++], 2e-16) << k;
    }
  }
}

/// Four-point differences differentiate quartics exactly.
TEST(TriangleJet, HasTheDerivativesOfItsValues) {
  const double h = 0.125;
  for (const auto& [u, v] : {std::array{0.3, 0.2}, std::array{0.0, 0.0}, std::array{0.1, 0.85}}) {
    const auto difference = [&, u = u, v = v](const std::array<double, 16> JetWeights::*part, double du, double dv,
                                              int k) {
      const auto at = [&](double steps) {
        JetWeights weights;
        triangle_jet_weights(u + steps * h * du, v + steps * h * dv, weights);
        return (weights.*part)[k];
      };
      return (8.0 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12.0 * h);
    };
    JetWeights weights;
    triangle_jet_weights(u, v, weights);
    for (int k = 0; k < kTrianglePatchSize; ++k) {
      EXPECT_NEAR(weights.du[k], difference(&JetWeights::value, 1, 0, k), 1e-14);
      EXPECT_NEAR(weights.dv[k], difference(&JetWeights::value, 0, 1, k), 1e-14);
      EXPECT_NEAR(weights.duu[k], difference(&JetWeights::du, 1, 0, k), 1e-14);
      EXPECT_NEAR(weights.duv[k], difference(&JetWeights::du, 0, 1, k), 1e-14);
      EXPECT_NEAR(weights.dvv[k], difference(&JetWeights::dv, 0, 1, k), 1e-14);
    }
  }
}

/// Second derivatives are cubic along a line, or less: four-point differences are exact.
TEST(RegularJet, HasTheThirdDerivativesOfItsSecondOnes) {
  const double h = 0.05;
  for (const bool quads : {true, false}) {
    for (const auto& [u, v] : {std::array{0.3, 0.2}, std::array{0.1, 0.75}}) {
      const auto difference = [&, u = u, v = v](const std::array<double, 16> JetWeights::*part, double du, double dv,
                                                int k) {
        const auto at = [&](double steps) {
          JetWeights weights;
          jet_weights(quads, u + steps * h * du, v + steps * h * dv, weights);
          return (weights.*part)[k];
        };
        return (8.0 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12.0 * h);
      };
      ThirdWeights third;
      third_weights(quads, u, v, third);
      for (int k = 0; k < patch_size(quads); ++k) {
        EXPECT_NEAR(third.duuu[k], difference(&JetWeights::duu, 1, 0, k), 1e-13);
        EXPECT_NEAR(third.duuv[k], difference(&JetWeights::duu, 0, 1, k), 1e-13);
        EXPECT_NEAR(third.duvv[k], difference(&JetWeights::dvv, 1, 0, k), 1e-13);
        EXPECT_NEAR(third.dvvv[k], difference(&JetWeights::dvv, 0, 1, k), 1e-13);
      }
    }
  }
}

}  // namespace
}  // namespace batten
