/// \file A picture as rows of pixels, and its PNG file.
#pragma once
#include <array>
#include <string>

#include "batten/buffer.h"

namespace batten {

using Color = std::array<float, 3>;  ///< linear, in [0, 1]

/// 8-bit sRGB rows from the top, 3 bytes a pixel.
struct Picture {
  int width = 0;
  int height = 0;
  Buffer<unsigned char> pixels;
};

/// The bytes of an 8-bit RGB PNG. Throws Error(BadShape) unless the pixels are width * height * 3.
Buffer<unsigned char> encode_png(const Picture& picture);

/// Writes encode_png's bytes, whole or not at all (output.h). Throws Error(BadShape, FileNotWritable).
void write_png(const std::string& path, const Picture& picture);

}  // namespace batten
