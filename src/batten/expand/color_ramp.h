/// \file Colours on a smooth curve through given colours.
#pragma once
#include <array>
#include <vector>

#include <Eigen/Core>

#include "batten/types.h"

namespace batten {

/// A cubic B-spline through a list of colours (key LC06, section 5) with uniform knots and no curvature at its ends.
/// Its control points solve the same equations as those of a boundary curve: (a + 4 b + c)/6 is the colour, and the end
/// points are their own.
class ColorRamp {
 public:
  /// colors: at least one, sRGB in [0, 1], evenly spaced from position 0 to 1. A colour given twice in a row keeps the
  /// curve at it. Throws Error(BadArgument) for an empty list or a colour out of range.
  explicit ColorRamp(const std::vector<std::array<double, 3>>& colors);

  /// Positions are clamped to [0, 1], and so are the colour's components where the curve overshoots.
  Eigen::RowVector3d color(double position) const;

 private:
  std::vector<Eigen::RowVector3d> control_;  ///< with one more at each end
};

}  // namespace batten
