/// \file Half the squared distance from the origin to the points S of a net, |S|^2 / 2: quadratic models of it, bounds
/// on it, and where it has its minimum.
#pragma once
#include <array>

#include "batten/nearest/bezier_net.h"

namespace batten {

/// |S|^2 / 2 near a place to second order: its gradient and its second derivatives by u and v.
struct DistanceModel {
  double gu, gv, huu, huv, hvv;

  explicit DistanceModel(const NetJet& jet)
      : gu(dot(jet.point, jet.du)),
        gv(dot(jet.point, jet.dv)),
        huu(dot(jet.du, jet.du) + dot(jet.point, jet.duu)),
        huv(dot(jet.du, jet.dv) + dot(jet.point, jet.duv)),
        hvv(dot(jet.dv, jet.dv) + dot(jet.point, jet.dvv)) {}

  bool is_convex() const { return huu > 0.0 && huu * hvv - huv * huv > 1e-12 * huu * hvv; }
  /// Leaves out the second derivatives of the surface (Gauss-Newton).
  void flatten(const NetJet& jet) {
    huu = dot(jet.du, jet.du);
    huv = dot(jet.du, jet.dv);
    hvv = dot(jet.dv, jet.dv);
  }
  double at(double u, double v) const {
    return gu * u + gv * v + 0.5 * (huu * u * u + 2.0 * huv * u * v + hvv * v * v);
  }
};

/// Moves (u, v), where the model was made, to the model's minimum in the cell. The model is convex.
template <typename Net>
void move_to_least(const DistanceModel& model, double& u, double& v);

/// A bound on how far |S|^2 / 2 falls below its value at (u, v) within the cell, where its second derivatives are at
/// least `modulus` (NetFrame::convexity): it lies above the paraboloid of that curvature which touches it at (u, v).
template <typename Net>
double most_decrease(const DistanceModel& model, const NetFrame<Net>& frame, double modulus, double u, double v);

/// The sides towards which |S|^2 falls from everywhere in the cell. Side c runs from corner c to the next.
template <typename Net>
std::array<bool, Net::kCorners> falling_sides(const Double4* net);

/// Finds where on a side |S|^2 is least, as a fraction t of the side. False where there may be several such places.
template <typename Net>
bool find_least_on_side(const Double4* net, int side, double& t);

}  // namespace batten
