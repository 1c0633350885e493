/// \file Colours between given ones, along a smooth curve.
#pragma once
#include <array>
#include <vector>

#include <Eigen/Core>

#include "batten/types.h"

namespace batten {

/// A cubic B-spline through a list of colours (key LC06, section 5): uniform knots, no curvature at its ends. Its
/// control points come from the same rows as a boundary curve's: (a + 4 b + c)/6 is the colour, the ends are their own.
class ColorRamp {
 public:
  /// colors: at least one, sRGB in [0, 1], evenly spaced from position 0 to 1; one given twice in a row holds the curve
  /// there. Throws Error(BadArgument) for none or one out of range.
  explicit ColorRamp(const std::vector<std::array<double, 3>>& colors);

  /// Positions outside [0, 1] are moved to its ends; so is what the curve overshoots in the colour.
  Eigen::RowVector3d color(double position) const;

 private:
  std::vector<Eigen::RowVector3d> control_;  ///< with one more at either end
};

}  // namespace batten
