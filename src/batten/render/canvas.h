/// \file Draws lines, areas and text with Cairo, on a picture or in an SVG file.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "batten/render/picture.h"

namespace batten::render_detail {

using Spot = Eigen::Vector2d;  ///< pixels from the left and from the top

struct Ink {
  double red;
  double green;
  double blue;
  double alpha = 1.0;
};

constexpr Ink ink(unsigned hex, double alpha = 1.0) {
  return {(hex >> 16 & 255U) / 255.0, (hex >> 8 & 255U) / 255.0, (hex & 255U) / 255.0, alpha};
}

Ink ink_of(const Color& color);

/// Dark on a light background, light on a dark one.
Ink text_ink(const PictureStyle& style);

enum class Align { Left, Centre, Right };

struct TextStyle {
  double size;  ///< of the font, in pixels
  Ink ink;
  Align align = Align::Left;
  bool bold = false;
};

struct Stroke {
  double width;
  Ink ink;
  double dash = 0.0;  ///< the length of dashes and gaps; 0: solid
};

/// Text is UTF-8 in DejaVu Sans or the system's substitute, unhinted so that it scales as lines do.
class Canvas {
 public:
  enum class Kind {
    Picture,
    Clear,  ///< a picture with alpha, which starts transparent
    Svg
  };
  Canvas(int width, int height, Kind kind);
  ~Canvas();
  Canvas(Canvas&&) noexcept;

  void fill(const Ink& ink);
  void rectangle(const Spot& top_left, const Spot& size, const Ink& ink);
  void polygon(const std::vector<Spot>& corners, const Ink& ink);
  void line(const std::vector<Spot>& points, const Stroke& stroke);
  void disc(const Spot& centre, double radius, const Ink& ink);
  /// `at` is on the baseline.
  void text(const Spot& at, const std::string& words, const TextStyle& style);
  /// Puts the picture's top left pixel at (left, top).
  void paste(const Picture& picture, int left, int top);
  double text_width(const std::string& words, const TextStyle& style) const;

  /// The pixels. Not for Kind::Svg.
  Picture picture() const;
  /// The file's bytes, for Kind::Svg. Nothing can be drawn afterwards.
  Buffer<unsigned char> svg();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace batten::render_detail
