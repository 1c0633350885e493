/// \file A place on a surface.
#pragma once
#include "batten/types.h"

namespace batten {

/// A face of the base and (u, v) in it: u runs from its first corner to its second, v to a quad's fourth, to a
/// triangle's third.
struct SurfacePlace {
  Index face = 0;
  double u = 0.0;
  double v = 0.0;
};

}  // namespace batten
