/// \file Numbers as colours: the maps, the range that a picture shows, and the bar that says so.
#pragma once
#include <string>

#include "batten/render/picture.h"
#include "batten/types.h"

namespace batten {

/// Which colours stand for which numbers.
enum class ColorMap {
  Sequential,  ///< viridis (Smith and van der Walt 2015): dark violet for little, yellow for much
  Diverging,   ///< cool to warm (Moreland 2009, key M09): blue below the middle, grey at it, red above
  Warm         ///< its upper half: grey for nothing, red for much
};

/// The colour at a position in [0, 1]. Grey for NaN.
Color map_color(ColorMap map, double position);

/// Colours for numbers, and the words of their bar.
struct ColorScale {
  ColorMap map = ColorMap::Sequential;
  std::string title;
  std::string unit;  ///< empty for a pure number
  bool log = false;
  bool whole = false;  ///< ticks at whole numbers only
  double low = 0.0;    ///< what the bar's ends stand for; numbers outside have the ends' colours
  double high = 1.0;
  double lowest = 0.0;  ///< of the numbers themselves
  double highest = 1.0;

  /// In [0, 1] between low and high; NaN for NaN.
  double position(double value) const;
};

/// What to scale to colours, and how.
struct ScaleRequest {
  std::string title;
  std::string unit;
  ColorMap map = ColorMap::Sequential;
  double middle = 0.0;  ///< Diverging: the number in the middle of the bar, which reaches as far to both sides
  bool log = false;  ///< Sequential: over at most six powers of ten below the high end; linear where none is positive
  bool whole = false;
  double outliers = 0.0;  ///< the share of the numbers that may lie beyond either end of the bar
};

/// Fits the bar's ends to the numbers; NaN and infinities do not count. A linear bar of numbers that are not negative
/// starts at zero if it would start near it. O(n).
/// Throws Error(BadArgument) for outliers outside [0, 0.4].
ColorScale fit_color_scale(const Eigen::Ref<const Scalars>& values, const ScaleRequest& request);

/// The bar with its title, unit and ticks, to stand beside a picture of this height; its width follows the text.
/// Where numbers lie beyond an end, that end is an arrow, and the extreme is written beside it.
/// Throws Error(BadArgument) for a height below 16 or above 32768.
Picture draw_color_bar(const ColorScale& scale, int height, const PictureStyle& style = {});

}  // namespace batten
