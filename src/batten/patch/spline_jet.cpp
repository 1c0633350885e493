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

/// The highest derivatives of a triangle's patch at (0, 0); numbers of points as in kTriangleLattice. The second ones
/// are along u, along v and mixed; the fourth ones, which are constant, along u and along v.
struct BoxSplineEnds {
  Double4 uu, vv, diagonal, uv, uuu, uuv, uvv, vvv, uuuu, vvvv;
};

template <typename Point>
inline BoxSplineEnds box_spline_ends(const Point& p) {
  const auto bend = [](const Double4& before, const Double4& at, const Double4& after) {
    return (before + after) - 2.0 * at;
  };
  BoxSplineEnds ends;
  ends.uu = bend(p(6), p(0), p(1));
  ends.vv = bend(p(3), p(0), p(2));
  ends.diagonal = bend(p(4), p(0), p(8));
  ends.uv = 0.5 * (ends.uu + ends.vv - ends.diagonal);
  ends.uuv = bend(p(8), p(2), p(9)) - ends.uu;
  ends.uvv = bend(p(4), p(1), p(9)) - ends.vv;
  ends.uuu = bend(p(3), p(4), p(5)) - ends.uu + ends.uuv;
  ends.vvv = bend(p(6), p(8), p(10)) - ends.vv + ends.uvv;
  ends.uuuu = bend(p(0), p(1), p(7)) - ends.uu - ends.uuu;
  ends.vvvv = bend(p(0), p(2), p(11)) - ends.vv - ends.vvv;
  return ends;
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

namespace {

constexpr std::array<Index, kTrianglePatchSize> kPatchRows{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
using PatchPoints = std::array<Double4, kTrianglePatchSize>;

/// Four basis functions of a triangle's patch, those from 4 four on: the patch whose points are rows of the identity.
PatchPoints four_functions(int four) {
  PatchPoints points{};
  for (int k = 0; k < 4; ++k) points[4 * four + k][k] = 1.0;
  return points;
}

void quad_third_weights(double u, double v, ThirdWeights& weights) {
  static constexpr double kThird[4] = {-1.0, 3.0, -3.0, 1.0};
  const CubicJet along = spline_jet(u);
  const CubicJet across = spline_jet(v);
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      weights.duuu[4 * j + i] = kThird[i] * across.value[j];
      weights.duuv[4 * j + i] = along.second[i] * across.first[j];
      weights.duvv[4 * j + i] = along.first[i] * across.second[j];
      weights.dvvv[4 * j + i] = along.value[i] * kThird[j];
    }
  }
}

void triangle_third_weights(double u, double v, ThirdWeights& weights) {
  for (int four = 0; four < kTrianglePatchSize / 4; ++four) {
    const PatchPoints points = four_functions(four);
    const BoxSplineEnds ends = box_spline_ends([&](int i) { return points[i]; });
    const Double4 duuu = ends.uuu + (2.0 * u + v) * ends.uuuu;
    const Double4 duuv = ends.uuv + u * ends.uuuu;
    const Double4 duvv = ends.uvv + v * ends.vvvv;
    const Double4 dvvv = ends.vvv + (2.0 * v + u) * ends.vvvv;
    for (int k = 0; k < 4; ++k) {
      weights.duuu[4 * four + k] = duuu[k];
      weights.duuv[4 * four + k] = duuv[k];
      weights.duvv[4 * four + k] = duvv[k];
      weights.dvvv[4 * four + k] = dvvv[k];
    }
  }
}

}  // namespace

void third_weights(bool quads, double u, double v, ThirdWeights& weights) {
  if (quads) return quad_third_weights(u, v, weights);
  triangle_third_weights(u, v, weights);
}

void triangle_jet_weights(double u, double v, JetWeights& weights) {
  std::array<double, 16>* parts[6] = {&weights.value, &weights.du,  &weights.dv,
                                      &weights.duu,   &weights.duv, &weights.dvv};
  for (int four = 0; four < kTrianglePatchSize / 4; ++four) {
    const PatchPoints points = four_functions(four);
    PatchJet functions;
    triangle_jet(u, v, points.data(), kPatchRows.data(), functions);
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
  const auto [uu, vv, diagonal, uv, uuu, uuv, uvv, vvv, uuuu, vvvv] = box_spline_ends(p);
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
