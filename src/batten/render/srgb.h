/// \file Conversion between linear light and sRGB (IEC 61966-2-1).
#pragma once
#include <cmath>

namespace batten::render_detail {

inline float encode_srgb(float linear) {
  return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
}

inline float decode_srgb(float encoded) {
  return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

}  // namespace batten::render_detail
