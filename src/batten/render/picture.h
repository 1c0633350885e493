/// \file A picture as rows of pixels, and its PNG file.
#pragma once
#include <array>
#include <string>

#include "batten/buffer.h"

namespace batten {

using Color = std::array<float, 3>;  ///< linear, in [0, 1]

/// Rows of 8-bit sRGB from the top, with `channels` bytes for each pixel: 3, or 4 with alpha last (not premultiplied).
struct Picture {
  int width = 0;
  int height = 0;
  int channels = 3;
  Buffer<unsigned char> pixels;
};

/// The background of a picture.
struct PictureStyle {
  Color background{0.96F, 0.96F, 0.95F};
  bool transparent = false;  ///< no background but alpha in the picture; text is still chosen for `background`
  /// Of captions, which then stand below their pictures, and of colour bars, in pixels. 0: 1/34 of the picture's
  /// height, with captions over its foot.
  double text_size = 0.0;
};

/// Throws Error(BadShape) unless both sizes are above 0 and the pixels are width * height * channels bytes.
void check_picture(const Picture& picture);

/// The bytes of an 8-bit PNG, RGB or RGBA. Throws what check_picture throws.
Buffer<unsigned char> encode_png(const Picture& picture);

/// Writes encode_png's bytes with write_bytes (output.h). Throws Error(BadShape, FileNotWritable).
void write_png(const std::string& path, const Picture& picture);

}  // namespace batten
