#include "batten/nearest/bezier_net.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "batten/patch/spline_jet.h"

namespace batten {

namespace {

using Matrix4 = std::array<std::array<double, 4>, 4>;

/// From four control points of a uniform cubic B-spline to the points of its Bezier polynomial.
constexpr Matrix4 kFromSpline{{{1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0, 0.0},
                               {0.0, 4.0 / 6.0, 2.0 / 6.0, 0.0},
                               {0.0, 2.0 / 6.0, 4.0 / 6.0, 0.0},
                               {0.0, 1.0 / 6.0, 4.0 / 6.0, 1.0 / 6.0}}};
/// To the first and to the second half of a cubic Bezier polynomial.
constexpr Matrix4 kFirstHalf{
    {{1.0, 0.0, 0.0, 0.0}, {0.5, 0.5, 0.0, 0.0}, {0.25, 0.5, 0.25, 0.0}, {0.125, 0.375, 0.375, 0.125}}};
constexpr Matrix4 kSecondHalf{
    {{0.125, 0.375, 0.375, 0.125}, {0.0, 0.25, 0.5, 0.25}, {0.0, 0.0, 0.5, 0.5}, {0.0, 0.0, 0.0, 1.0}}};

template <std::size_t kRows, std::size_t kInner, std::size_t kColumns>
std::array<std::array<double, kColumns>, kRows> multiply(
    const std::array<std::array<double, kInner>, kRows>& left,
    const std::array<std::array<double, kColumns>, kInner>& right) {
  std::array<std::array<double, kColumns>, kRows> result{};
  for (std::size_t r = 0; r < kRows; ++r) {
    for (std::size_t k = 0; k < kInner; ++k) {
      for (std::size_t c = 0; c < kColumns; ++c) result[r][c] += left[r][k] * right[k][c];
    }
  }
  return result;
}

/// Row i has the weights of a triangle's net at place i.
using NetValues = std::array<std::array<double, TriangleNet::kPoints>, TriangleNet::kPoints>;

/// Values at the places (i, j)/4 of a part of the triangle.
NetValues net_values(const Placement& part) {
  NetValues values;
  for (int j = 0; j <= 4; ++j) {
    for (int i = 0; i + j <= 4; ++i) {
      for (int k = 0; k < TriangleNet::kPoints; ++k) {
        std::array<Double4, TriangleNet::kPoints> unit{};
        unit[k] = Double4{1.0, 0.0, 0.0, 0.0};
        values[TriangleNet::index(i, j)][k] = TriangleNet::jet(unit.data(), part.u(i / 4.0), part.v(j / 4.0)).point[0];
      }
    }
  }
  return values;
}

/// The net with given values: polynomials of degree 4 follow from their values at the places. All weights are multiples
/// of `unit`, so rounding to them takes the errors of the solution away.
template <int kColumns>
NetMatrix<TriangleNet, kColumns> net_of_values(const std::array<std::array<double, kColumns>, TriangleNet::kPoints>& at,
                                               double unit) {
  using Square = Eigen::Matrix<double, TriangleNet::kPoints, TriangleNet::kPoints, Eigen::RowMajor>;
  using Rows = Eigen::Matrix<double, TriangleNet::kPoints, kColumns, Eigen::RowMajor>;
  const NetValues values = net_values({});
  const Rows solution =
      Square(Eigen::Map<const Square>(values[0].data())).fullPivLu().solve(Rows(Eigen::Map<const Rows>(at[0].data())));
  NetMatrix<TriangleNet, kColumns> matrix;
  for (int r = 0; r < TriangleNet::kPoints; ++r) {
    for (int c = 0; c < kColumns; ++c) matrix.rows[r][c] = std::round(solution(r, c) / unit) * unit;
  }
  return matrix;
}

SplineMatrix<TriangleNet> make_spline_matrix() {
  std::array<std::array<double, kTrianglePatchSize>, TriangleNet::kPoints> values;
  for (int j = 0; j <= 4; ++j) {
    for (int i = 0; i + j <= 4; ++i) {
      JetWeights weights;
      triangle_jet_weights(i / 4.0, j / 4.0, weights);
      std::copy_n(weights.value.begin(), kTrianglePatchSize, values[TriangleNet::index(i, j)].begin());
    }
  }
  return net_of_values<kTrianglePatchSize>(values, 1.0 / 24.0);
}

/// The cubic Bernstein polynomials.
CubicJet bernstein_jet(double t) {
  const double s = 1.0 - t;
  return {{s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t},
          {-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t},
          {6.0 * s, 6.0 * (t - 2.0 * s), 6.0 * (s - 2.0 * t), 6.0 * t}};
}

}  // namespace

void NetMatrix<QuadNet, 16>::apply(const Double4* from, Double4* to) const {
  std::array<Double4, 16> half;
  for (int j = 0; j < 4; ++j) {
    const Double4* row = from + 4 * j;
    for (int i = 0; i < 4; ++i) {
      const std::array<double, 4>& w = along[i];
      half[4 * j + i] = (w[0] * row[0] + w[1] * row[1]) + (w[2] * row[2] + w[3] * row[3]);
    }
  }
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const std::array<double, 4>& w = across[j];
      to[4 * j + i] = (w[0] * half[i] + w[1] * half[4 + i]) + (w[2] * half[8 + i] + w[3] * half[12 + i]);
    }
  }
}

template <typename Net, int kColumns>
void NetMatrix<Net, kColumns>::apply(const Double4* from, Double4* to) const {
  for (int r = 0; r < Net::kPoints; ++r) {
    Double4 even{};
    Double4 odd{};
    int k = 0;
    for (; k + 1 < kColumns; k += 2) {
      even += rows[r][k] * from[k];
      odd += rows[r][k + 1] * from[k + 1];
    }
    if (k < kColumns) even += rows[r][k] * from[k];
    to[r] = even + odd;
  }
}

template <>
const SplineMatrix<QuadNet>& spline_matrix<QuadNet>() {
  static constexpr SplineMatrix<QuadNet> kMatrix{kFromSpline, kFromSpline};
  return kMatrix;
}
template <>
const SplineMatrix<TriangleNet>& spline_matrix<TriangleNet>() {
  static const SplineMatrix<TriangleNet> matrix = make_spline_matrix();
  return matrix;
}

template <>
const HalfMatrix<QuadNet>& half_matrix<QuadNet>(int child) {
  static constexpr HalfMatrix<QuadNet> kMatrices[4] = {
      {kFirstHalf, kFirstHalf}, {kSecondHalf, kFirstHalf}, {kSecondHalf, kSecondHalf}, {kFirstHalf, kSecondHalf}};
  return kMatrices[child];
}
template <>
const HalfMatrix<TriangleNet>& half_matrix<TriangleNet>(int child) {
  const auto make = [](int number) {
    return net_of_values<TriangleNet::kPoints>(net_values(half<TriangleNet>(number)), 1.0 / 16.0);
  };
  static const std::array<HalfMatrix<TriangleNet>, 4> matrices{make(0), make(1), make(2), make(3)};
  return matrices[child];
}

SplineMatrix<QuadNet> product(const HalfMatrix<QuadNet>& half, const SplineMatrix<QuadNet>& part) {
  return {multiply(half.along, part.along), multiply(half.across, part.across)};
}
SplineMatrix<TriangleNet> product(const HalfMatrix<TriangleNet>& half, const SplineMatrix<TriangleNet>& part) {
  return {multiply(half.rows, part.rows)};
}

NetJet QuadNet::jet(const Double4* net, double u, double v) {
  const CubicJet along = bernstein_jet(u);
  const CubicJet across = bernstein_jet(v);
  NetJet jet{};
  for (int j = 0; j < 4; ++j) {
    const Double4* row = net + 4 * j;
    const auto sum = [row](const double* w) { return w[0] * row[0] + w[1] * row[1] + w[2] * row[2] + w[3] * row[3]; };
    const Double4 value = sum(along.value);
    const Double4 first = sum(along.first);
    jet.point += across.value[j] * value;
    jet.dv += across.first[j] * value;
    jet.dvv += across.second[j] * value;
    jet.du += across.value[j] * first;
    jet.duv += across.first[j] * first;
    jet.duu += across.value[j] * sum(along.second);
  }
  return jet;
}

/// De Casteljau's scheme is followed down to the quadratic net, from whose points the jet follows.
NetJet TriangleNet::jet(const Double4* net, double u, double v) {
  const double w = 1.0 - u - v;
  std::array<Double4, 10> cubic;
  std::array<Double4, 6> quadratic;
  int to = 0;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i + j < 4; ++i) {
      cubic[to++] = w * net[index(i, j)] + u * net[index(i + 1, j)] + v * net[index(i, j + 1)];
    }
  }
  const auto cubic_index = [](int i, int j) { return 4 * j - j * (j - 1) / 2 + i; };
  to = 0;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i + j < 3; ++i) {
      quadratic[to++] =
          w * cubic[cubic_index(i, j)] + u * cubic[cubic_index(i + 1, j)] + v * cubic[cubic_index(i, j + 1)];
    }
  }
  const auto& [ww, uw, uu, vw, uv, vv] = quadratic;
  const Double4 at_w = w * ww + u * uw + v * vw;
  const Double4 at_u = w * uw + u * uu + v * uv;
  const Double4 at_v = w * vw + u * uv + v * vv;
  return {w * at_w + u * at_u + v * at_v, 4.0 * (at_u - at_w),        4.0 * (at_v - at_w),
          12.0 * (uu - 2.0 * uw + ww),    12.0 * (uv - uw - vw + ww), 12.0 * (vv - 2.0 * vw + ww)};
}

template <typename Net>
NetFrame<Net>::NetFrame(const Double4* net) {
  constexpr double kLeastAngle = 1e-6;  // a cell of a smaller angle is as good as a line
  const Double4 du = Net::mean_du(net);
  const Double4 dv = Net::mean_dv(net);
  du_length = std::sqrt(dot(du, du));
  const Double4 e0 = du / (du_length > 0.0 ? du_length : 1.0);
  dv_along = dot(e0, dv);
  const Double4 rest = dv - dv_along * e0;
  dv_across = std::sqrt(dot(rest, rest));
  flat_enough = dv_across > kLeastAngle * (std::abs(dv_along) + du_length) && du_length > kLeastAngle * dv_across;
  Double4 x{1.0, 0.0, 0.0, 0.0};
  Double4 y{0.0, 1.0, 0.0, 0.0};
  Double4 z{0.0, 0.0, 1.0, 0.0};
  if (flat_enough) {
    const Double4 e1 = rest / dv_across;
    const Double4 e2 = cross(e0, e1);
    x = Double4{e0[0], e1[0], e2[0], 0.0};
    y = Double4{e0[1], e1[1], e2[1], 0.0};
    z = Double4{e0[2], e1[2], e2[2], 0.0};
  }
  for (int i = 0; i < Net::kPoints; ++i) points[i] = net[i][0] * x + net[i][1] * y + net[i][2] * z;
  low = high = points[0];
  for (int i = 1; i < Net::kPoints; ++i) {
    low = lower(low, points[i]);
    high = higher(high, points[i]);
  }
}

template <typename Net>
double NetFrame<Net>::least_squared() const {
  return squared_distance_of_box(low, high);
}

template <typename Net>
void NetFrame<Net>::guess(double& u, double& v) const {
  u = v = Net::kMiddle;
  if (!flat_enough) return;
  Double4 middle{};
  for (int c = 0; c < Net::kCorners; ++c) middle += points[Net::kCorner[c]];
  middle /= static_cast<double>(Net::kCorners);
  const double across = -middle[1] / dv_across;
  u = std::clamp(u + (-middle[0] - dv_along * across) / du_length, 0.0, 1.0);
  v = std::clamp(v + across, 0.0, 1.0);
  if (Net::kCorners == 3 && u + v > 1.0) {
    const double beyond = 0.5 * (u + v - 1.0);
    u = std::clamp(u - beyond, 0.0, 1.0);
    v = 1.0 - u;
  }
}

namespace {

/// Bounds on the second derivatives S_ww by directions w of length 1 in the mean metric: their normal coordinates lie
/// between `least` and `most`, and their tangential parts are no longer than `tangential`.
struct SecondBounds {
  double least = 0.0;
  double most = 0.0;
  double tangential = 0.0;
};

template <typename Net>
SecondBounds second_bounds(const NetFrame<Net>& frame) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::array<Double4, 3> low;
  std::array<Double4, 3> high;
  low.fill(Double4{kFar, kFar, kFar, kFar});
  high.fill(-low[0]);
  Net::second_derivatives(frame.points.data(), [&](const Double4& d, int which) {
    low[which] = lower(low[which], d);
    high[which] = higher(high[which], d);
  });
  std::array<double, 3> along;
  for (int k = 0; k < 3; ++k) {
    const Double4 most = higher(high[k], -low[k]);
    along[k] = std::sqrt(most[0] * most[0] + most[1] * most[1]);
  }
  // Let p and q be the coordinates in the mean tangent plane: p = du_length u + dv_along v and q = dv_across v. With
  // a = 1 / du_length, b = dv_along / du_length and c = 1 / dv_across, d/dp = a d/du and d/dq = c (d/dv - b d/du).
  const double a = 1.0 / frame.du_length;
  const double c = 1.0 / frame.dv_across;
  const double b = frame.dv_along * a;
  const double shear = std::abs(b);
  const auto combine = [&](const std::array<double, 3>& d, double sign) {
    return std::array<double, 3>{d[0] * a * a, (d[1] + sign * b * d[0]) * a * c,
                                 (d[2] + sign * 2.0 * b * d[1] + b * b * d[0]) * c * c};
  };
  const auto combine_sizes = [&](const std::array<double, 3>& d) {
    return std::array<double, 3>{d[0] * a * a, (d[1] + shear * d[0]) * a * c,
                                 (d[2] + 2.0 * shear * d[1] + b * b * d[0]) * c * c};
  };
  const auto norm = [](const std::array<double, 3>& d) {
    return std::sqrt(d[0] * d[0] + 2.0 * d[1] * d[1] + d[2] * d[2]);
  };
  std::array<double, 3> centre;
  std::array<double, 3> radius;
  for (int k = 0; k < 3; ++k) {
    centre[k] = 0.5 * (low[k][2] + high[k][2]);
    radius[k] = 0.5 * (high[k][2] - low[k][2]);
  }
  const std::array<double, 3> form = combine(centre, -1.0);
  const double mean = 0.5 * (form[0] + form[2]);
  const double spread = std::sqrt(0.25 * (form[0] - form[2]) * (form[0] - form[2]) + form[1] * form[1]);
  const double error = norm(combine_sizes(radius));
  return {mean - spread - error, mean + spread + error, norm(combine_sizes(along))};
}

/// How far the map from the mean metric to the surface, seen in the mean tangent plane, is from an isometry: a bound on
/// the norm of the difference between its derivative and the identity.
template <typename Net>
double first_bound(const NetFrame<Net>& frame) {
  std::array<Double4, 2> most{};
  const Double4 mean[2] = {{frame.du_length, 0.0, 0.0, 0.0}, {frame.dv_along, frame.dv_across, 0.0, 0.0}};
  Net::first_derivatives(frame.points.data(), [&](const Double4& d, int which) {
    const Double4 off = d - mean[which];
    most[which] = higher(most[which], off * off);
  });
  const double in_u = std::sqrt(most[0][0] + most[0][1]) / frame.du_length;
  const double in_v = (std::sqrt(most[1][0] + most[1][1]) + std::abs(frame.dv_along) * in_u) / frame.dv_across;
  return std::sqrt(in_u * in_u + in_v * in_v);
}

}  // namespace

/// Let S_w be the derivative of the points S by a direction w of length 1 in the mean metric. Then
/// (S.S/2)_ww = S_w.S_w + S.S_ww. The first term is at least (1 - first_bound)^2, or 0 where that bound exceeds 1. The
/// second is bounded by its normal part, a product of two intervals, and its tangential part, a product of two lengths.
template <typename Net>
double NetFrame<Net>::convexity() const {
  if (!flat_enough) return 0.0;
  const double turn = first_bound(*this);
  const SecondBounds second = second_bounds(*this);
  const double normal =
      std::min({low[2] * second.least, low[2] * second.most, high[2] * second.least, high[2] * second.most});
  const double far0 = std::max(std::abs(low[0]), std::abs(high[0]));
  const double far1 = std::max(std::abs(low[1]), std::abs(high[1]));
  const double along = std::sqrt(far0 * far0 + far1 * far1);
  const double least_metric = std::max(1.0 - turn, 0.0);
  return least_metric * least_metric + normal - along * second.tangential;
}

template <typename Net>
double NetFrame<Net>::bend() const {
  if (!flat_enough) return 1.0;
  const SecondBounds second = second_bounds(*this);
  const double size = std::max(du_length, std::sqrt(dv_along * dv_along + dv_across * dv_across));
  return first_bound(*this) + size * std::max(std::abs(second.least), std::abs(second.most));
}

template struct NetMatrix<TriangleNet, TriangleNet::kSplinePoints>;
template struct NetMatrix<TriangleNet, TriangleNet::kPoints>;
template struct NetFrame<QuadNet>;
template struct NetFrame<TriangleNet>;

}  // namespace batten
