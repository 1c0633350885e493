/// \file From a place in a face to the child that it lies in.
#pragma once
#include "batten/types.h"

namespace batten {

/// A double has no smaller fractions of a face: after so many halvings here is the vertex itself.
inline constexpr int kHalvingsToVertex = 53;

/// One of four children, in RingTypes' order, and how much faster its parameters run: a triangle's middle child is
/// turned, backwards.
struct Halving {
  int child;
  double factor;
};

/// (u, v) become the child's own.
inline Halving halve(bool quads, double& u, double& v) {
  u *= 2.0;
  v *= 2.0;
  if (quads) {
    static constexpr int kChildren[4] = {0, 1, 3, 2};
    const int right = u >= 1.0 ? 1 : 0;
    const int up = v >= 1.0 ? 1 : 0;
    u -= right;
    v -= up;
    return {kChildren[right + 2 * up], 2.0};
  }
  if (u >= 1.0) {
    u -= 1.0;
    return {1, 2.0};
  }
  if (v >= 1.0) {
    v -= 1.0;
    return {2, 2.0};
  }
  if (u + v <= 1.0) return {0, 2.0};
  u = 1.0 - u;
  v = 1.0 - v;
  return {3, -2.0};
}

/// The corner of a face next to a place.
inline Index nearest_corner(bool quads, double u, double v) {
  if (quads) return u < 0.5 ? (v < 0.5 ? 0 : 3) : (v < 0.5 ? 1 : 2);
  return u > 0.5 ? 1 : v > 0.5 ? 2 : 0;
}

}  // namespace batten
