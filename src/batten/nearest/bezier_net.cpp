#include "batten/nearest/bezier_net.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "batten/patch/spline_jet.h"

namespace batten {

namespace {

/// The polynomials of a net at the places of its points: at (i, j)/n, where n is the degree.
template <typename Net>
void place_of(int point, double& u, double& v);
template <>
void place_of<QuadNet>(int point, double& u, double& v) {
  const int row = point / 4;
  u = (point - 4 * row) / 3.0;
  v = row / 3.0;
}
template <>
void place_of<TriangleNet>(int point, double& u, double& v) {
  for (int j = 0; j <= 4; ++j) {
    for (int i = 0; i + j <= 4; ++i) {
      if (TriangleNet::index(i, j) != point) continue;
      u = i / 4.0;
      v = j / 4.0;
    }
  }
}

void spline_weights(QuadNet /*net*/, double u, double v, JetWeights& weights) { quad_jet_weights(u, v, weights); }
void spline_weights(TriangleNet /*net*/, double u, double v, JetWeights& weights) {
  triangle_jet_weights(u, v, weights);
}

/// Weights of the net's points at a place, as the jet function has them.
template <typename Net>
std::array<double, Net::kPoints> net_weights(double u, double v) {
  std::array<double, Net::kPoints> weights;
  for (int k = 0; k < Net::kPoints; ++k) {
    std::array<Double4, Net::kPoints> unit{};
    unit[k] = Double4{1.0, 0.0, 0.0, 0.0};
    weights[k] = Net::jet(unit.data(), u, v).point[0];
  }
  return weights;
}

/// Polynomials of the degree follow from their values at the places of the net's points. All weights are multiples of
/// `unit`, which takes the rounding away.
template <typename Net>
NetTables<Net> make_tables(double spline_unit, double half_unit) {
  constexpr int kCount = Net::kPoints;
  Eigen::MatrixXd values(kCount, kCount);
  Eigen::MatrixXd spline(kCount, Net::kSplinePoints);
  for (int p = 0; p < kCount; ++p) {
    double u = 0.0;
    double v = 0.0;
    place_of<Net>(p, u, v);
    const auto weights = net_weights<Net>(u, v);
    JetWeights own;
    spline_weights(Net(), u, v, own);
    for (int k = 0; k < kCount; ++k) values(p, k) = weights[k];
    for (int k = 0; k < Net::kSplinePoints; ++k) spline(p, k) = own.value[k];
  }
  const Eigen::FullPivLU<Eigen::MatrixXd> solver(values);
  NetTables<Net> tables;
  const Eigen::MatrixXd from_spline = solver.solve(spline);
  for (int p = 0; p < kCount; ++p) {
    for (int k = 0; k < Net::kSplinePoints; ++k)
      tables.from_spline[p][k] = std::round(from_spline(p, k) / spline_unit) * spline_unit;
  }
  for (int child = 0; child < 4; ++child) {
    const Placement part = half<Net>(child);
    Eigen::MatrixXd at(kCount, kCount);
    for (int p = 0; p < kCount; ++p) {
      double u = 0.0;
      double v = 0.0;
      place_of<Net>(p, u, v);
      const auto weights = net_weights<Net>(part.u(u), part.v(v));
      for (int k = 0; k < kCount; ++k) at(p, k) = weights[k];
    }
    const Eigen::MatrixXd half_weights = solver.solve(at);
    for (int p = 0; p < kCount; ++p) {
      for (int k = 0; k < kCount; ++k)
        tables.halves[child][p][k] = std::round(half_weights(p, k) / half_unit) * half_unit;
    }
  }
  return tables;
}

/// Bernstein polynomials.
CubicJet bernstein_jet(double t) {
  const double s = 1.0 - t;
  return {{s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t},
          {-3.0 * s * s, 3.0 * s * (s - 2.0 * t), 3.0 * t * (2.0 * s - t), 3.0 * t * t},
          {6.0 * s, 6.0 * (t - 2.0 * s), 6.0 * (s - 2.0 * t), 6.0 * t}};
}

}  // namespace

const NetTables<QuadNet>& quad_tables() {
  static const NetTables<QuadNet> tables = make_tables<QuadNet>(1.0 / 36.0, 1.0 / 64.0);
  return tables;
}

const NetTables<TriangleNet>& triangle_tables() {
  static const NetTables<TriangleNet> tables = make_tables<TriangleNet>(1.0 / 24.0, 1.0 / 16.0);
  return tables;
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

/// De Casteljau's scheme down to the quadratic net, whose points have all that is asked.
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
  constexpr double kLeastAngle = 1e-6;  // below it the cell is as good as a line
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
    const Double4 e2{e0[1] * e1[2] - e0[2] * e1[1], e0[2] * e1[0] - e0[0] * e1[2], e0[0] * e1[1] - e0[1] * e1[0], 0.0};
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
  double sum = 0.0;
  for (int c = 0; c < 3; ++c) {
    const double beyond = std::max({low[c], -high[c], 0.0});
    sum += beyond * beyond;
  }
  return sum;
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

/// Bounds on second derivatives by parameters of unit metric: of the normal part as an interval of its eigenvalues, of
/// the tangential part by its length.
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
  // (u, v) = (p - b q / c, q) / ... : with du = (a, 0) and dv = (b, c), d/dp = d/du / a and d/dq = (d/dv - b/a d/du)/c.
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

/// How far the tangential derivatives by parameters of unit metric are from an isometry.
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

/// With S = point of the cell, S_w its derivative by a unit direction: (S.S/2)_ww = S_w.S_w + S.S_ww, where the first
/// is at least (1 - first_bound)^2, and the second is taken apart into normal and tangential parts.
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

template struct NetFrame<QuadNet>;
template struct NetFrame<TriangleNet>;

}  // namespace batten
