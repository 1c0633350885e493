#include "batten/limit/spline_jet.h"

#include <Eigen/LU>
#include <cmath>

#include "batten/limit/tile_weights.h"

namespace batten {

namespace {

struct CubicJet {
  double value[4], first[4], second[4];
};

CubicJet cubic_jet(double t) {
  const double s = 1.0 - t;
  return {{s * s * s / 6.0, (4.0 - 6.0 * t * t + 3.0 * t * t * t) / 6.0, (4.0 - 6.0 * s * s + 3.0 * s * s * s) / 6.0,
           t * t * t / 6.0},
          {-0.5 * s * s, t * (1.5 * t - 2.0), s * (2.0 - 1.5 * s), 0.5 * t * t},
          {s, 3.0 * t - 2.0, 3.0 * s - 2.0, t}};
}

constexpr int kDegree = 4;
constexpr int kTerms = 15;  ///< of a quartic in two variables

/// u^a v^b for a + b <= 4, in the order of the coefficients.
template <typename Visit>
void for_each_term(const Visit& visit) {
  int term = 0;
  for (int b = 0; b <= kDegree; ++b) {
    for (int a = 0; a + b <= kDegree; ++a) visit(term++, a, b);
  }
}

/// Coefficients of u^a v^b of the twelve basis functions. They are quartics over a triangle, so their values at the
/// lattice of quarters, which subdivision gives, decide them; multiples of 1/12.
Eigen::Matrix<double, kTerms, kTrianglePatchSize> box_spline_coefficients() {
  const Buffer<double> values = triangle_weights(kDegree, TileValue::Limit);
  Eigen::Matrix<double, kTerms, kTerms> powers;
  Eigen::Matrix<double, kTerms, kTrianglePatchSize> samples;
  for_each_term([&](int point, int i, int j) {  // triangle_weights goes through its points as for_each_term does
    const double u = i / 4.0;
    const double v = j / 4.0;
    for_each_term([&](int term, int a, int b) { powers(point, term) = std::pow(u, a) * std::pow(v, b); });
    for (int k = 0; k < kTrianglePatchSize; ++k) samples(point, k) = values[point * kTrianglePatchSize + k];
  });
  Eigen::Matrix<double, kTerms, kTrianglePatchSize> coefficients = powers.fullPivLu().solve(samples);
  return (coefficients * 12.0).array().round().matrix() / 12.0;
}

}  // namespace

void quad_jet_weights(double u, double v, JetWeights& weights) {
  const CubicJet along = cubic_jet(u);
  const CubicJet across = cubic_jet(v);
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      weights.value[4 * j + i] = along.value[i] * across.value[j];
      weights.du[4 * j + i] = along.first[i] * across.value[j];
      weights.dv[4 * j + i] = along.value[i] * across.first[j];
      weights.duu[4 * j + i] = along.second[i] * across.value[j];
      weights.duv[4 * j + i] = along.first[i] * across.first[j];
      weights.dvv[4 * j + i] = along.value[i] * across.second[j];
    }
  }
}

void triangle_jet_weights(double u, double v, JetWeights& weights) {
  static const Eigen::Matrix<double, kTerms, kTrianglePatchSize> coefficients = box_spline_coefficients();
  Eigen::Matrix<double, 6, kTerms> terms;
  const double us[kDegree + 1] = {1.0, u, u * u, u * u * u, u * u * u * u};
  const double vs[kDegree + 1] = {1.0, v, v * v, v * v * v, v * v * v * v};
  for_each_term([&](int term, int a, int b) {
    const double ua = us[a];
    const double vb = vs[b];
    const double du = a > 0 ? a * us[a - 1] : 0.0;
    const double dv = b > 0 ? b * vs[b - 1] : 0.0;
    terms(0, term) = ua * vb;
    terms(1, term) = du * vb;
    terms(2, term) = ua * dv;
    terms(3, term) = a > 1 ? a * (a - 1) * us[a - 2] * vb : 0.0;
    terms(4, term) = du * dv;
    terms(5, term) = b > 1 ? b * (b - 1) * ua * vs[b - 2] : 0.0;
  });
  const Eigen::Matrix<double, 6, kTrianglePatchSize> all = terms * coefficients;
  std::array<double, 16>* rows[6] = {&weights.value, &weights.du,  &weights.dv,
                                     &weights.duu,   &weights.duv, &weights.dvv};
  for (int r = 0; r < 6; ++r) {
    for (int k = 0; k < kTrianglePatchSize; ++k) (*rows[r])[k] = all(r, k);
  }
}

}  // namespace batten
