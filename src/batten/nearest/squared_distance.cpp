#include "batten/nearest/squared_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace batten {

namespace {

constexpr int kMostSideSteps = 24;

template <typename Net>
bool inside(double u, double v) {
  return u >= 0.0 && v >= 0.0 && (Net::kCorners == 4 ? u <= 1.0 && v <= 1.0 : u + v <= 1.0);
}

/// Intervals of x, y and z that hold the points added so far.
struct Box {
  Double4 low;
  Double4 high;
  bool empty = true;

  void add(const Double4& point) {
    low = empty ? point : lower(low, point);
    high = empty ? point : higher(high, point);
    empty = false;
  }
  double least_squared() const { return squared_distance_of_box(low, high); }
};

/// A lower bound on the scalar product of a vector in one box and a vector in the other.
double least_dot(const Box& a, const Box& b) {
  double sum = 0.0;
  for (int c = 0; c < 3; ++c) {
    sum += std::min({a.low[c] * b.low[c], a.low[c] * b.high[c], a.high[c] * b.low[c], a.high[c] * b.high[c]});
  }
  return sum;
}

Box negative(const Box& box) { return {-box.high, -box.low, box.empty}; }

}  // namespace

template <typename Net>
void move_to_least(const DistanceModel& model, double& u, double& v) {
  const double det = model.huu * model.hvv - model.huv * model.huv;
  const double free_u = u - (model.hvv * model.gu - model.huv * model.gv) / det;
  const double free_v = v - (model.huu * model.gv - model.huv * model.gu) / det;
  if (inside<Net>(free_u, free_v)) {
    u = free_u;
    v = free_v;
    return;
  }
  double least = std::numeric_limits<double>::infinity();
  double best_u = u;
  double best_v = v;
  for (int c = 0; c < Net::kCorners; ++c) {
    const int next = (c + 1) % Net::kCorners;
    const double a = Net::kCornerU[c];
    const double b = Net::kCornerV[c];
    const double du = Net::kCornerU[next] - a;
    const double dv = Net::kCornerV[next] - b;
    const double slope = (model.gu + model.huu * (a - u) + model.huv * (b - v)) * du +
                         (model.gv + model.huv * (a - u) + model.hvv * (b - v)) * dv;
    const double bend = model.huu * du * du + 2.0 * model.huv * du * dv + model.hvv * dv * dv;
    const double t = bend > 0.0 ? std::clamp(-slope / bend, 0.0, 1.0) : 0.0;
    const double value = model.at(a + t * du - u, b + t * dv - v);
    if (!(value < least)) continue;
    least = value;
    best_u = a + t * du;
    best_v = b + t * dv;
  }
  u = best_u;
  v = best_v;
}

template <typename Net>
double most_decrease(const DistanceModel& model, const NetFrame<Net>& frame, double modulus, double u, double v) {
  const double concave = std::min(modulus, 0.0);
  double most = 0.0;  // of the corners: where the paraboloid is not convex, it is least at one of them
  for (int c = 0; c < Net::kCorners; ++c) {
    const double du = Net::kCornerU[c] - u;
    const double dv = Net::kCornerV[c] - v;
    const double along = frame.du_length * du + frame.dv_along * dv;
    const double across = frame.dv_across * dv;
    most = std::max(most, -(model.gu * du + model.gv * dv) - 0.5 * concave * (along * along + across * across));
  }
  if (!(modulus > 0.0)) return most;
  const double along = model.gu / frame.du_length;
  const double across = (model.gv - frame.dv_along * along) / frame.dv_across;
  return std::min(most, (along * along + across * across) / (2.0 * modulus));
}

template <typename Net>
std::array<bool, Net::kCorners> falling_sides(const Double4* net) {
  std::array<bool, Net::kCorners> falls_to;
  Box points;
  std::array<Box, 2> slopes;
  for (int i = 0; i < Net::kPoints; ++i) points.add(net[i]);
  Net::first_derivatives(net, [&](const Double4& slope, int which) { slopes[which].add(slope); });
  const bool rises_in_u = least_dot(points, slopes[0]) >= 0.0;
  const bool rises_in_v = least_dot(points, slopes[1]) >= 0.0;
  const bool falls_in_u = least_dot(points, negative(slopes[0])) >= 0.0;
  const bool falls_in_v = least_dot(points, negative(slopes[1])) >= 0.0;
  falls_to[0] = rises_in_v;
  falls_to[Net::kCorners - 1] = rises_in_u;
  if constexpr (Net::kCorners == 4) {
    falls_to[1] = falls_in_u;
    falls_to[2] = falls_in_v;
  } else {
    falls_to[1] = falls_in_u || falls_in_v;
  }
  return falls_to;
}

template <typename Net>
bool find_least_on_side(const Double4* net, int side, double& t) {
  constexpr int kDegree = Net::kCorners == 4 ? 3 : 4;
  std::array<Double4, kDegree + 1> curve;
  Net::side(net, side, curve.data());
  Box points;
  Box slopes;
  Box bends;
  for (int i = 0; i <= kDegree; ++i) points.add(curve[i]);
  for (int i = 0; i < kDegree; ++i) slopes.add(static_cast<double>(kDegree) * (curve[i + 1] - curve[i]));
  for (int i = 0; i + 1 < kDegree; ++i)
    bends.add(static_cast<double>(kDegree * (kDegree - 1)) * (curve[i + 2] - 2.0 * curve[i + 1] + curve[i]));
  if (least_dot(points, slopes) >= 0.0 || least_dot(points, negative(slopes)) >= 0.0) {
    t = dot(curve[0], curve[0]) <= dot(curve[kDegree], curve[kDegree]) ? 0.0 : 1.0;
    return true;
  }
  const double modulus = slopes.least_squared() + least_dot(points, bends);
  if (!(modulus > 0.0)) return false;
  t = 0.5;
  for (int i = 0; i < kMostSideSteps; ++i) {
    const double u = (1.0 - t) * Net::kCornerU[side] + t * Net::kCornerU[(side + 1) % Net::kCorners];
    const double v = (1.0 - t) * Net::kCornerV[side] + t * Net::kCornerV[(side + 1) % Net::kCorners];
    const double along_u = Net::kCornerU[(side + 1) % Net::kCorners] - Net::kCornerU[side];
    const double along_v = Net::kCornerV[(side + 1) % Net::kCorners] - Net::kCornerV[side];
    const DistanceModel model(Net::jet(net, u, v));
    const double slope = model.gu * along_u + model.gv * along_v;
    const double bend =
        model.huu * along_u * along_u + 2.0 * model.huv * along_u * along_v + model.hvv * along_v * along_v;
    const double next = std::clamp(t - slope / bend, 0.0, 1.0);
    if (std::abs(next - t) < 1e-14) return true;
    t = next;
  }
  return false;
}

template void move_to_least<QuadNet>(const DistanceModel&, double&, double&);
template void move_to_least<TriangleNet>(const DistanceModel&, double&, double&);
template double most_decrease(const DistanceModel&, const NetFrame<QuadNet>&, double, double, double);
template double most_decrease(const DistanceModel&, const NetFrame<TriangleNet>&, double, double, double);
template std::array<bool, 4> falling_sides<QuadNet>(const Double4*);
template std::array<bool, 3> falling_sides<TriangleNet>(const Double4*);
template bool find_least_on_side<QuadNet>(const Double4*, int, double&);
template bool find_least_on_side<TriangleNet>(const Double4*, int, double&);

}  // namespace batten
