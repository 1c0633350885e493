/// \file Numbers as colours: colour maps, the range of numbers that a picture shows, and its colour bar.
#pragma once
#include <array>
#include <optional>
#include <string>

#include "batten/render/picture.h"
#include "batten/types.h"

namespace batten {

/// Which colours represent which numbers.
enum class ColorMap {
  Sequential,  ///< viridis (Smith and van der Walt 2015): dark violet for small, yellow for large numbers
  Diverging,   ///< cool to warm (Moreland 2009, key M09): blue below the middle, grey at it, red above
  Warm,        ///< the upper half of Diverging: grey for small, red for large numbers
  Cool         ///< the lower half of Diverging: blue for small (far below zero), grey for large numbers
};

/// The colour at a position in [0, 1]; grey for NaN.
Color map_color(ColorMap map, double position);

/// Maps numbers to colours, with the labels of the bar.
struct ColorScale {
  ColorMap map = ColorMap::Sequential;
  std::string title;
  std::string unit;  ///< empty for a pure number
  bool log = false;
  bool whole = false;  ///< ticks at whole numbers only
  double low = 0.0;    ///< the numbers at the bar's ends; numbers outside have the ends' colours
  double high = 1.0;
  double lowest = 0.0;  ///< the range of the numbers themselves
  double highest = 1.0;
  double share_below = 0.0;  ///< of the numbers, those beyond the bar's low end
  double share_above = 0.0;

  /// A position in [0, 1] between low and high; NaN for NaN.
  double position(double value) const;
};

/// Options of fit_color_scale.
struct ScaleRequest {
  std::string title;
  std::string unit;
  ColorMap map = ColorMap::Sequential;
  /// Diverging: the number in the middle of the bar, which extends equally far to both sides. If all numbers lie on
  /// one side of it, the bar covers them alone, from the middle if they start near it, and is Warm or Cool.
  double middle = 0.0;
  bool log = false;  ///< Sequential: over at most six powers of ten below the high end; linear if no number is positive
  bool whole = false;
  /// The share of the numbers that may lie beyond each end of the bar, so that a few cannot take it. Where only so few
  /// differ from all others, the bar covers them.
  double outliers = 0.02;
  std::optional<std::array<double, 2>> range = std::nullopt;  ///< the bar's ends, instead of fitted ones
};

/// Fits the bar's ends to the numbers, without NaN and infinities. A linear bar of numbers that are not negative starts
/// at zero if it would start near it. A given range is taken as it is; a logarithmic bar whose range does not lie above
/// zero is linear. O(n). Throws Error(BadArgument) for outliers outside [0, 0.4] and for a range whose ends are not
/// finite numbers in ascending order.
ColorScale fit_color_scale(const Eigen::Ref<const Scalars>& values, const ScaleRequest& request);

/// The bar with its title, unit and ticks for a picture of this height; its width follows the text. If numbers lie
/// beyond an end, that end is an arrow, with the share of these numbers and the extreme one beside it. Throws
/// Error(BadArgument) for a height below 16 or above 32768.
/// The words have the size of the style, and the bar what room they leave.
Picture draw_color_bar(const ColorScale& scale, int height, const PictureStyle& style = {});

}  // namespace batten
