#include "batten/scheme/butterfly.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "support/dense.h"

namespace batten {
namespace {

constexpr double kPi = std::numbers::pi;
/// Some dozen roundings of numbers of order 1.
constexpr double kTolerance = 1e-14;

using Function = std::function<double(double, double)>;

double apply(const RingMask& mask, const Function& f, double step) {
  double sum = mask.vertex * f(0.0, 0.0);
  for (std::size_t j = 0; j < mask.edges.size(); ++j) {
    sum += mask.edges[j] * f(std::cos(static_cast<double>(j) * step), std::sin(static_cast<double>(j) * step));
  }
  return sum;
}

TEST(ButterflyMasks, StencilsSumToOne) {
  for (const auto kind : {SchemeKind::Butterfly, SchemeKind::ModifiedButterfly}) {
    for (const double tension : {0.0, 1.0 / 16.0, -0.03, 0.2}) {
      Scheme scheme;
      scheme.kind = kind;
      scheme.tension = tension;
      const ButterflyMask mask = butterfly_mask(scheme);
      EXPECT_NEAR(2 * mask.end + 2 * mask.opposite + 4 * mask.wing + 2 * mask.beyond, 1.0, kTolerance);
    }
  }
}

/// Both schemes are the same eight points unless told otherwise.
TEST(ButterflyMasks, AreTheSameByDefault) {
  Scheme plain;
  plain.kind = SchemeKind::Butterfly;
  Scheme modified;
  modified.kind = SchemeKind::ModifiedButterfly;
  EXPECT_EQ(butterfly_mask(plain).end, butterfly_mask(modified).end);
  EXPECT_EQ(butterfly_mask(plain).opposite, butterfly_mask(modified).opposite);
  EXPECT_EQ(butterfly_mask(plain).wing, butterfly_mask(modified).wing);
  EXPECT_EQ(butterfly_mask(plain).beyond, butterfly_mask(modified).beyond);
}

/// docs/mathematics.md, Butterfly: on the ring of unit edges 1, x, y, x^2 + y^2, x^2 - y^2 and xy take the value of the
/// edge's middle; K = 3 has no room for the last two.
TEST(ButterflyMasks, ExtraordinaryRingsReproduceQuadratics) {
  const std::vector<Function> functions{[](double, double) { return 1.0; },
                                        [](double x, double) { return x; },
                                        [](double, double y) { return y; },
                                        [](double x, double y) { return x * x + y * y; },
                                        [](double x, double y) { return x * x - y * y; },
                                        [](double x, double y) { return x * y; }};
  for (const int n : {3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 360}) {
    const std::size_t exact = n == 3 ? 4 : functions.size();
    for (std::size_t i = 0; i < exact; ++i) {
      EXPECT_NEAR(apply(extraordinary_mask(n), functions[i], 2 * kPi / n), functions[i](0.5, 0.0), kTolerance)
          << "valence " << n << ", function " << i;
    }
  }
  const double wrong = apply(extraordinary_mask(3), functions[4], 2 * kPi / 3) - 0.25;
  EXPECT_NEAR(std::abs(wrong), 0.25, kTolerance);  // the paper's "some second degree polynomials"
}

/// The spectra of the ring's subdivision matrix.
TEST(ButterflyMasks, RingsHaveTheEigenvaluesOfTheNote) {
  for (int n = 3; n <= 12; ++n) {
    const RingMask mask = extraordinary_mask(n);
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n + 1, n + 1);
    matrix(0, 0) = 1.0;
    for (int i = 0; i < n; ++i) {
      matrix(1 + i, 0) = mask.vertex;
      for (int j = 0; j < n; ++j) matrix(1 + i, 1 + (i + j) % n) = mask.edges[j];
    }
    Eigen::VectorXd values = test::eigenvalues(matrix).cwiseAbs();
    std::sort(values.data(), values.data() + values.size(), std::greater<>());
    std::vector<double> expected{1.0, 0.5, 0.5, 0.25};
    if (n == 4) expected.push_back(0.25);
    if (n >= 5) expected.insert(expected.end(), {0.25, 0.25});
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(values[static_cast<int>(i)], expected[i], 1e-12) << n;
  }
}

/// The half ring of unit edges: 1, x, y and r^2 sin 2 theta.
TEST(ButterflyMasks, CreaseRingsReproduceLinearFunctionsAndOneQuadratic) {
  const std::vector<Function> functions{[](double, double) { return 1.0; }, [](double x, double) { return x; },
                                        [](double, double y) { return y; },
                                        [](double x, double y) { return 2 * x * y; }};
  for (const int k : {2, 4, 5, 6, 7, 12, 180}) {
    for (int i = 1; i < k; ++i) {
      const double angle = i * kPi / k;
      for (const Function& f : functions) {
        EXPECT_NEAR(apply(crease_vertex_mask(k, i), f, kPi / k), f(0.5 * std::cos(angle), 0.5 * std::sin(angle)),
                    kTolerance)
            << k << " triangles, edge " << i;
      }
    }
  }
}

/// As v = (0, 0), x = (0, 1) of a lattice with a boundary along (1, 0) (docs/mathematics.md, Butterfly).
TEST(ButterflyMasks, BoundaryStencilsReproduceQuadratics) {
  const std::vector<Function> functions{
      [](double, double) { return 1.0; },       [](double x, double) { return x; },
      [](double, double y) { return y; },       [](double x, double) { return x * x; },
      [](double x, double y) { return x * y; }, [](double, double y) { return y * y; }};
  const OneWingMissing one;
  const SideMissing side;
  for (const Function& f : functions) {
    const double one_wing = one.v * f(0, 0) + one.x * f(0, 1) + one.opposite_a * f(1, 0) + one.opposite_b * f(-1, 1) +
                            one.wing_v_b * f(-1, 0) + one.wing_x_a * f(1, 1) + one.wing_x_b * f(-1, 2);
    EXPECT_NEAR(one_wing, f(0.0, 0.5), kTolerance);
    const double one_side =
        side.end * (f(0, 0) + f(0, 1)) + side.opposite_b * f(-1, 1) + side.wing_b * (f(-1, 0) + f(-1, 2));
    EXPECT_NEAR(one_side, f(0.0, 0.5), kTolerance);
  }
}

}  // namespace
}  // namespace batten
