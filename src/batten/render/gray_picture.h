/// \file A picture of numbers in shades of grey, with lines on it: a slice of a volume and what cuts it.
#pragma once
#include <array>
#include <vector>

#include "batten/render/picture.h"
#include "batten/types.h"

namespace batten {

/// Rows of numbers from the top, each a rectangle of one shade.
struct GrayImage {
  Values numbers;
  double pixel_width = 1.0;
  double pixel_height = 1.0;
  /// From x, y to x, y, in numbers from the top left corner of the picture.
  std::vector<std::array<double, 4>> lines;
};

/// How an image is drawn.
struct GrayStyle {
  double black = 0.0;  ///< this number and less
  double white = 1.0;  ///< this number and more
  double scale = 4.0;  ///< pixels of the picture for a unit of pixel_width and pixel_height
  Color line_color{0.90F, 0.22F, 0.03F};
  double line_width = 2.0;  ///< pixels
};

/// Throws Error(BadArgument) for no numbers, or a scale that makes more than 16384 pixels along a side.
Picture draw_gray(const GrayImage& image, const GrayStyle& style = {});

}  // namespace batten
