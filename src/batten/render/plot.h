/// \file Line plots, for example of the residual against the iteration.
#pragma once
#include <string>
#include <vector>

#include "batten/render/picture.h"

namespace batten {

/// One line of a plot.
struct PlotLine {
  std::string name;        ///< written at the line's end, or in a legend if there is no room; may be empty
  std::vector<double> x;   ///< finite; as many as y
  std::vector<double> y;   ///< the line breaks where y is not finite, or not positive on a logarithmic axis
  bool reference = false;  ///< thin, grey and dashed: a threshold for comparison
};

/// Lines over a pair of axes.
struct Plot {
  std::string title;
  std::string x_label;
  std::string y_label;
  bool log_y = false;  ///< ignored if no y is positive
  std::vector<PlotLine> lines;
};

/// Draws a plot in colours for colour-blind readers (seven, then repeated), with sizes in proportion to the picture.
/// Throws Error: BadArgument (no point to draw; a side below 200 or above 16384), BadShape (x and y of different
/// lengths), NotFinite (x).
Picture draw_plot(const Plot& plot, int width = 1280, int height = 800);

/// The bytes of an SVG file with the same plot.
Buffer<unsigned char> encode_svg(const Plot& plot, int width = 1280, int height = 800);

/// Writes .png or .svg by the extension. Throws Error(UnknownFormat, FileNotWritable) and what draw_plot throws.
void write_plot(const std::string& path, const Plot& plot);

}  // namespace batten
