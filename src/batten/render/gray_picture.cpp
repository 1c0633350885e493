#include "batten/render/gray_picture.h"

#include <algorithm>
#include <cmath>

#include "batten/error.h"
#include "batten/render/canvas.h"

namespace batten {

Picture draw_gray(const GrayImage& image, const GrayStyle& style) {
  constexpr double kMostPixels = 16384.0;
  const double across = style.scale * image.pixel_width;
  const double down = style.scale * image.pixel_height;
  const double width = std::round(across * static_cast<double>(image.numbers.cols()));
  const double height = std::round(down * static_cast<double>(image.numbers.rows()));
  if (!(width >= 1.0 && height >= 1.0 && width <= kMostPixels && height <= kMostPixels))
    throw Error(ErrorCode::BadArgument, "a picture of 0 or of more than 16384 pixels along a side");
  Picture shades;
  shades.width = static_cast<int>(width);
  shades.height = static_cast<int>(height);
  shades.pixels.resize(static_cast<std::size_t>(3) * shades.width * shades.height);
  const double range = std::max(style.white - style.black, 1e-300);
  for (int y = 0; y < shades.height; ++y) {
    const auto row = std::min(static_cast<Eigen::Index>((y + 0.5) / down), image.numbers.rows() - 1);
    for (int x = 0; x < shades.width; ++x) {
      const auto column = std::min(static_cast<Eigen::Index>((x + 0.5) / across), image.numbers.cols() - 1);
      const double share = std::clamp((image.numbers(row, column) - style.black) / range, 0.0, 1.0);
      unsigned char* const pixel = &shades.pixels[3 * (static_cast<std::size_t>(y) * shades.width + x)];
      std::fill(pixel, pixel + 3, static_cast<unsigned char>(std::lround(255.0 * share)));
    }
  }
  using namespace render_detail;
  Canvas canvas(shades.width, shades.height, Canvas::Kind::Picture);
  canvas.paste(shades, 0, 0);
  const Stroke stroke{style.line_width, ink_of(style.line_color)};
  for (const std::array<double, 4>& line : image.lines)
    canvas.line({Spot(across * line[0], down * line[1]), Spot(across * line[2], down * line[3])}, stroke);
  return canvas.picture();
}

}  // namespace batten
