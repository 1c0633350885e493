/// \file The rays of the eye: their directions, and packets of them.
#pragma once
#include <embree3/rtcore.h>

#include "batten/render/view.h"

namespace batten::render_detail {

/// A camera with a picture in front of it.
struct Eye {
  Camera camera;
  int width;  ///< of the picture, in pixels
  int height;

  /// The direction through a place of the picture, in pixels from its top left; of length 1.
  Vec direction(float x, float y) const {
    const float across = (2.0F * x / static_cast<float>(width) - 1.0F) * camera.tangent_x;
    const float up = (1.0F - 2.0F * y / static_cast<float>(height)) * camera.tangent_y;
    return (camera.forward + across * camera.right + up * camera.up).normalized();
  }

  /// The size of a pixel at the distance of the shape's centre, in the frame's unit.
  float pixel_size() const { return 2.0F * camera.tangent_y * camera.eye.norm() / static_cast<float>(height); }

  /// Makes a lane of a packet a ray from the eye.
  void aim(RTCRayHit16& rays, int lane, const Vec& way) const;
};

}  // namespace batten::render_detail
