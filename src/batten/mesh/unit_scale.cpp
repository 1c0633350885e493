#include "batten/mesh/unit_scale.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace batten {

double unit_scale(ConstValuesRef values) {
  constexpr int kOrdinary = 200;
  const double largest = values.size() > 0 ? values.cwiseAbs().maxCoeff() : 0.0;
  if (!(largest > 0.0) || !std::isfinite(largest)) return 1.0;
  const int exponent = std::ilogb(largest);
  return std::abs(exponent) <= kOrdinary ? 1.0 : std::ldexp(1.0, std::min(-exponent, 1023));
}

}  // namespace batten
