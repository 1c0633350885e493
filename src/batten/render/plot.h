/// \file Plots of lines: what an iteration did, how methods compare.
#pragma once
#include <string>
#include <vector>

#include "batten/render/picture.h"

namespace batten {

/// One line of a plot.
struct PlotLine {
  std::string name;        ///< written at the line's end, or in a legend where there is no room; may be empty
  std::vector<double> x;   ///< finite; as many as y
  std::vector<double> y;   ///< the line breaks where y is not finite, or not positive on a logarithmic axis
  bool reference = false;  ///< thin, grey and dashed: a threshold to compare with
};

/// Lines over a pair of axes.
struct Plot {
  std::string title;
  std::string x_label;
  std::string y_label;
  bool log_y = false;  ///< linear all the same where no y is positive
  std::vector<PlotLine> lines;
};

/// Colours that the colour-blind can tell apart (seven, then again); sizes in proportion to the picture.
/// Throws Error: BadArgument (no point to draw; a side below 200 or above 16384), BadShape (x and y of different
/// lengths), NotFinite (x).
Picture draw_plot(const Plot& plot, int width = 1280, int height = 800);

/// The text of an SVG file that shows the same.
Buffer<unsigned char> encode_svg(const Plot& plot, int width = 1280, int height = 800);

/// By the extension: .png or .svg. Throws Error(UnknownFormat, FileNotWritable) and what draw_plot throws.
void write_plot(const std::string& path, const Plot& plot);

}  // namespace batten
