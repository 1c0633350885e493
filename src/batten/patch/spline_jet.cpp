#include "batten/patch/spline_jet.h"

namespace batten {

namespace {

/// B-spline basis functions of one knot span.
inline CubicJet spline_jet(double t) {
  constexpr double kSixth = 1.0 / 6.0;
  const double s = 1.0 - t;
  return {{kSixth * (s * s * s), 4.0 * kSixth + t * t * (0.5 * t - 1.0), 4.0 * kSixth + s * s * (0.5 * s - 1.0),
           kSixth * (t * t * t)},
          {-0.5 * s * s, t * (1.5 * t - 2.0), s * (2.0 - 1.5 * s), 0.5 * t * t},
          {s, 3.0 * t - 2.0, 3.0 * s - 2.0, t}};
}

}  // namespace

void quad_jet_weights(double u, double v, JetWeights& weights) {
  const CubicJet along = spline_jet(u);
  const CubicJet across = spline_jet(v);
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

/// Of four basis functions at a time, as the jet of a patch whose points are the rows of the identity.
void triangle_jet_weights(double u, double v, JetWeights& weights) {
  std::array<double, 16>* parts[6] = {&weights.value, &weights.du,  &weights.dv,
                                      &weights.duu,   &weights.duv, &weights.dvv};
  static constexpr std::array<Index, kTrianglePatchSize> kRows{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  for (int four = 0; four < kTrianglePatchSize / 4; ++four) {
    std::array<Double4, kTrianglePatchSize> points{};
    for (int k = 0; k < 4; ++k) points[4 * four + k][k] = 1.0;
    PatchJet functions;
    triangle_jet(u, v, points.data(), kRows.data(), functions);
    for (int part = 0; part < 6; ++part) {
      for (int k = 0; k < 4; ++k) (*parts[part])[4 * four + k] = functions[part][k];
    }
  }
}

void quad_jet(double u, double v, const Double4* points, const Index* rows, PatchJet& jet) {
  const CubicJet along = spline_jet(u);
  const CubicJet across = spline_jet(v);
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

/// The box spline's second derivatives are second differences of the points, blended by box splines of lower degree;
/// the rest follows by integration (de Boor, Hoellig and Riemenschneider 1993, key BHR93).
void triangle_jet(double u, double v, const Double4* points, const Index* rows, PatchJet& jet) {
  const auto p = [&](int i) { return points[rows[i]]; };
  const auto bend = [](const Double4& before, const Double4& at, const Double4& after) {
    return (before + after) - 2.0 * at;
  };
  // At (0, 0): along u, along v, along v - u, then how the first two change. Numbers as in kTriangleLattice.
  const Double4 uu = bend(p(6), p(0), p(1));
  const Double4 vv = bend(p(3), p(0), p(2));
  const Double4 diagonal = bend(p(4), p(0), p(8));
  const Double4 uv = 0.5 * (uu + vv - diagonal);
  const Double4 uuv = bend(p(8), p(2), p(9)) - uu;
  const Double4 uvv = bend(p(4), p(1), p(9)) - vv;
  const Double4 uu_below = bend(p(3), p(4), p(5)) - uu;
  const Double4 vv_left = bend(p(6), p(8), p(10)) - vv;
  const Double4 uuu = uu_below + uuv;
  const Double4 vvv = vv_left + uvv;
  const Double4 uuuu = bend(p(0), p(1), p(7)) - uu - uuu;
  const Double4 vvvv = bend(p(0), p(2), p(11)) - vv - vvv;
  const Double4 along = p(1) - p(6);
  const Double4 across = p(2) - p(3);
  const Double4 askew = p(4) - p(8);
  const Double4 value = p(0) + (1.0 / 12.0) * (uu + vv + diagonal);
  const Double4 du = (1.0 / 6.0) * (2.0 * along + across + askew);
  const Double4 dv = (1.0 / 6.0) * (along + 2.0 * across - askew);

  const double u2 = 0.5 * u * u;
  const double v2 = 0.5 * v * v;
  const double u3 = u * u2 / 3.0;
  const double v3 = v * v2 / 3.0;
  const double product = u * v;
  jet[3] = (uu + u * uuu) + (v * uuv + (u * (u + v)) * uuuu);
  jet[5] = (vv + v * vvv) + (u * uvv + (v * (u + v)) * vvvv);
  jet[4] = (uv + u * uuv) + (v * uvv + (u2 * uuuu + v2 * vvvv));
  jet[1] =
      ((du + u * uu) + (v * uv + u2 * uuu)) + ((product * uuv + v2 * uvv) + ((2.0 * u3 + v * u2) * uuuu + v3 * vvvv));
  jet[2] =
      ((dv + v * vv) + (u * uv + v2 * vvv)) + ((product * uvv + u2 * uuv) + ((2.0 * v3 + u * v2) * vvvv + u3 * uuuu));
  jet[0] = ((value + u * du) + (v * dv + u2 * uu)) + ((v2 * vv + product * uv) + (u3 * uuu + v3 * vvv)) +
           ((v * u2) * uuv + (u * v2) * uvv) + ((u3 * (0.5 * u + v)) * uuuu + (v3 * (0.5 * v + u)) * vvvv);
}

}  // namespace batten
