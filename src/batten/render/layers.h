/// \file What the rays found at each pixel, before light and shadow are put together.
#pragma once
#include <array>
#include <cstddef>

#include "batten/buffer.h"

namespace batten::render_detail {

/// One number a pixel. The shape's come first, means over its own samples; then the ground's.
enum class Plane {
  Coverage,  ///< the share of the pixel's samples that met the shape
  NormalX,
  NormalY,
  NormalZ,
  PositionX,
  PositionY,
  PositionZ,
  KeyRed,  ///< what the key light sends to the eye where nothing is in its way
  KeyGreen,
  KeyBlue,
  AmbientRed,  ///< what the sky and the fill send
  AmbientGreen,
  AmbientBlue,
  KeySeen,    ///< the share of the key light that is not hidden
  KeyWeight,  ///< the share of samples that know: 0 where the surface turns away from it
  SkySeen,
  GroundWeight,  ///< the share of the pixel's samples that met the ground near the shape
  GroundKeySeen,
  GroundSkySeen,
  Count
};

inline constexpr std::size_t kPlaneCount = static_cast<std::size_t>(Plane::Count);

struct Layers {
  int width;
  int height;
  std::array<Buffer<float>, kPlaneCount> planes;

  Layers(int w, int h) : width(w), height(h) {
    for (auto& plane : planes) plane.resize(static_cast<std::size_t>(w) * static_cast<std::size_t>(h));
  }
  Buffer<float>& plane(Plane which) { return planes[static_cast<std::size_t>(which)]; }
  const Buffer<float>& plane(Plane which) const { return planes[static_cast<std::size_t>(which)]; }
  const float* row(Plane which, int y) const {
    return plane(which).data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
  }
};

/// Smooths KeySeen, SkySeen and the ground's. `pixel` is a pixel's size in space, in the frame's unit.
///
/// The pattern of light rays is spread over blocks of 8x8 pixels, evenly in each square of 4x4: a box of 4x4 pixels
/// holds next to no noise, and the second pass adds the block's other squares. Neighbours count as far as they lie in
/// the pixel's tangent plane and face the same way. O(pixels): 16 neighbours each.
void smooth_light(Layers& layers, float pixel);

}  // namespace batten::render_detail
