/// \file The squared distance from a fixed point to a surface that moves, to second order.
#pragma once
#include <Eigen/Core>
#include <array>

#include "batten/surface/limit_surface.h"

namespace batten {

/// A symmetric 3-by-3 matrix: xx, xy, xz, yy, yz, zz.
using Form = std::array<double, 6>;

/// Of the distance to a point.
inline constexpr Form kPointForm{1.0, 0.0, 0.0, 1.0, 0.0, 1.0};

inline Eigen::Vector3d multiply(const Form& form, const Eigen::Vector3d& x) {
  return {form[0] * x[0] + form[1] * x[1] + form[2] * x[2], form[1] * x[0] + form[3] * x[1] + form[4] * x[2],
          form[2] * x[0] + form[4] * x[1] + form[5] * x[2]};
}

inline void scale(double factor, Form& form) {
  for (double& number : form) number *= factor;
}

/// M of the model (offset - x)^T M (offset - x), where x is how far the foot point moves and `offset` leads from it to
/// the point. M is 1 along the normal and |d| / (|d| + r) along the principal direction of radius r, at the distance
/// d: point distance far away, tangent distance nearby, never negative (Wang, Pottmann and Liu 2006, key WPL06; Cheng
/// and others 2007, key CWQ07). It is the identity where the offset is not along the normal, as at boundaries and
/// creases, or where the jet has no curvature.
Form distance_form(const Jet& jet, const Eigen::Vector3d& offset);

/// The same for a place of the surface and a point of the data with its normal: 1 along the normal, and along the
/// plane |t| / (|t| + 2 spacing), where t is the offset's part along the plane: between points of such spacing the
/// plane alone counts, and beyond them the point.
Form plane_form(const Eigen::Vector3d& normal, const Eigen::Vector3d& offset, double spacing);

}  // namespace batten
