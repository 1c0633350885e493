#include "batten/limit/spline_jet.h"

#include <Eigen/LU>
#include <cmath>

#include "batten/limit/tile_weights.h"

namespace batten {

namespace {

struct CubicJet {
  double value[4], first[4], second[4];
};

inline CubicJet cubic_jet(double t) {
  constexpr double kSixth = 1.0 / 6.0;
  const double s = 1.0 - t;
  return {{kSixth * (s * s * s), 4.0 * kSixth + t * t * (0.5 * t - 1.0), 4.0 * kSixth + s * s * (0.5 * s - 1.0),
           kSixth * (t * t * t)},
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

namespace {

/// The coefficients of four basis functions each, in rows by the power of v: of u^a v^b at [a][b].
struct BoxSpline {
  Double4 coefficients[kDegree + 1][kDegree + 1][3];

  BoxSpline() {
    const Eigen::Matrix<double, kTerms, kTrianglePatchSize> all = box_spline_coefficients();
    for_each_term([&](int term, int a, int b) {
      for (int k = 0; k < kTrianglePatchSize; ++k) coefficients[a][b][k / 4][k % 4] = all(term, k);
    });
  }
};

/// Four basis functions and their derivatives: Horner's rule in v for each power of u, then in u.
inline void four_functions(const BoxSpline& spline, int four, double u, double v, PatchJet& jet) {
  Double4 value[kDegree + 1];
  Double4 first[kDegree];
  Double4 second[kDegree - 1];
#pragma GCC unroll 5
  for (int a = 0; a <= kDegree; ++a) {
    Double4 p = spline.coefficients[a][kDegree - a][four];
    Double4 d{};
    Double4 dd{};
#pragma GCC unroll 4
    for (int b = kDegree - a - 1; b >= 0; --b) {
      dd = v * dd + d;
      d = v * d + p;
      p = v * p + spline.coefficients[a][b][four];
    }
    value[a] = p;
    if (a < kDegree) first[a] = d;
    if (a < kDegree - 1) second[a] = 2.0 * dd;
  }
  jet[0] = value[0] + u * (value[1] + u * (value[2] + u * (value[3] + u * value[4])));
  jet[1] = value[1] + u * (2.0 * value[2] + u * (3.0 * value[3] + u * (4.0 * value[4])));
  jet[2] = first[0] + u * (first[1] + u * (first[2] + u * first[3]));
  jet[3] = 2.0 * value[2] + u * (6.0 * value[3] + u * (12.0 * value[4]));
  jet[4] = first[1] + u * (2.0 * first[2] + u * (3.0 * first[3]));
  jet[5] = second[0] + u * (second[1] + u * second[2]);
}

const BoxSpline& box_spline() {
  static const BoxSpline spline;
  return spline;
}

}  // namespace

void triangle_jet_weights(double u, double v, JetWeights& weights) {
  std::array<double, 16>* rows[6] = {&weights.value, &weights.du,  &weights.dv,
                                     &weights.duu,   &weights.duv, &weights.dvv};
  PatchJet functions;
  for (int four = 0; four < 3; ++four) {
    four_functions(box_spline(), four, u, v, functions);
    for (int r = 0; r < 6; ++r) {
      for (int k = 0; k < 4; ++k) (*rows[r])[4 * four + k] = functions[r][k];
    }
  }
}

void quad_jet(double u, double v, const Double4* points, const Index* rows, PatchJet& jet) {
  const CubicJet along = cubic_jet(u);
  const CubicJet across = cubic_jet(v);
  PatchJet total{};  // a local, which points cannot overlap with: it stays in registers
  for (int j = 0; j < 4; ++j) {
    const Double4 p0 = points[rows[4 * j]];
    const Double4 p1 = points[rows[4 * j + 1]];
    const Double4 p2 = points[rows[4 * j + 2]];
    const Double4 p3 = points[rows[4 * j + 3]];
    const auto sum = [&](const double* w) { return (w[0] * p0 + w[1] * p1) + (w[2] * p2 + w[3] * p3); };
    const Double4 value = sum(along.value);
    const Double4 first = sum(along.first);
    const Double4 second = sum(along.second);
    total[0] += across.value[j] * value;
    total[1] += across.value[j] * first;
    total[2] += across.first[j] * value;
    total[3] += across.value[j] * second;
    total[4] += across.first[j] * first;
    total[5] += across.second[j] * value;
  }
  jet = total;
}

void triangle_jet(double u, double v, const Double4* points, const Index* rows, PatchJet& jet) {
  const BoxSpline& spline = box_spline();
  PatchJet functions[3];
  for (int four = 0; four < 3; ++four) four_functions(spline, four, u, v, functions[four]);
  // Two sums in turn: one would wait for itself.
  PatchJet even{};
  PatchJet odd{};
  for (int four = 0; four < 3; ++four) {
    for (int k = 0; k < 4; k += 2) {
      const Double4 first = points[rows[4 * four + k]];
      const Double4 second = points[rows[4 * four + k + 1]];
      for (int r = 0; r < 6; ++r) {
        even[r] += functions[four][r][k] * first;
        odd[r] += functions[four][r][k + 1] * second;
      }
    }
  }
  for (int r = 0; r < 6; ++r) jet[r] = even[r] + odd[r];
}

}  // namespace batten
