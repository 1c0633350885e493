/// \file Arithmetic on points that are the first three lanes of a Double4.
#pragma once
#include <algorithm>

#include "batten/double4.h"

namespace batten {

/// The scalar product of two points. The fourth lane of a point is not read.
inline double dot(const Double4& a, const Double4& b) {
  const Double4 products = a * b;
  return products[0] + products[1] + products[2];
}
/// The vector product of two points; its fourth lane is 0.
inline Double4 cross(const Double4& a, const Double4& b) {
  return Double4{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0], 0.0};
}
/// The minimum, and the maximum, lane by lane.
inline Double4 lower(const Double4& a, const Double4& b) { return a < b ? a : b; }
inline Double4 higher(const Double4& a, const Double4& b) { return a > b ? a : b; }

/// The squared distance of a box from the origin; 0 where the origin is in it.
inline double squared_distance_of_box(const Double4& low, const Double4& high) {
  double squared = 0.0;
  for (int c = 0; c < 3; ++c) {
    const double beyond = std::max({low[c], -high[c], 0.0});
    squared += beyond * beyond;
  }
  return squared;
}

}  // namespace batten
