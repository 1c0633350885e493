/// \file The results of the rays at each pixel, before light and shadow are combined.
#pragma once
#include <array>
#include <cstddef>

#include "batten/buffer.h"

namespace batten::render_detail {

/// A number for each pixel. Those from NormalX to SkySeen are means over the samples that hit the surface.
enum class Plane {
  Coverage,  ///< the share of the pixel's samples that hit the surface, a marker or a line
  Solid,     ///< the share that hit the surface, also behind a marker or a line
  NormalX,
  NormalY,
  NormalZ,
  PositionX,
  PositionY,
  PositionZ,
  KeyRed,  ///< the light that reaches the eye from the key light when nothing blocks it
  KeyGreen,
  KeyBlue,
  AmbientRed,  ///< the light from the sky and the fill light
  AmbientGreen,
  AmbientBlue,
  KeySeen,    ///< the share of the key light that is not blocked
  KeyWeight,  ///< the share of samples for which it is known: 0 where the surface faces away from the light
  SkySeen,
  GlowRed,  ///< the light that needs no lamp, as a mean over all of the pixel's samples: markers, lines, measured
            ///< colours
  GlowGreen,
  GlowBlue,
  GroundWeight,  ///< the share of the pixel's samples that hit the ground near the shape
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

/// Smooths KeySeen, SkySeen and the ground's planes. `pixel` is the size of a pixel in space, in the frame's unit.
///
/// The pattern of light rays is spread over blocks of 8x8 pixels, evenly in each square of 4x4: a box of 4x4 pixels has
/// almost no noise, and a second pass adds the other squares of the block. Neighbours are weighted by how close they
/// are to the pixel's tangent plane and how similar their normals are. O(pixels), with 16 neighbours each.
void smooth_light(Layers& layers, float pixel);

}  // namespace batten::render_detail
