#include "batten/render/eye.h"

#include <limits>

namespace batten::render_detail {

void Eye::aim(RTCRayHit16& rays, int lane, const Vec& way) const {
  rays.ray.org_x[lane] = camera.eye.x();
  rays.ray.org_y[lane] = camera.eye.y();
  rays.ray.org_z[lane] = camera.eye.z();
  rays.ray.dir_x[lane] = way.x();
  rays.ray.dir_y[lane] = way.y();
  rays.ray.dir_z[lane] = way.z();
  rays.ray.tnear[lane] = 0.0F;
  rays.ray.tfar[lane] = std::numeric_limits<float>::infinity();
  rays.ray.time[lane] = 0.0F;
  rays.ray.mask[lane] = ~0U;
  rays.ray.flags[lane] = 0;
}

}  // namespace batten::render_detail
