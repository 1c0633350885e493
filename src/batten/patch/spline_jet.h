/// \file Position and derivatives of regular patches: the uniform bicubic B-spline and Loop's quartic box spline.
#pragma once
#include <array>

#include "batten/double4.h"
#include "batten/patch/regular_patch.h"

namespace batten {

/// Weights of a patch's control points for the value and the derivatives up to the second, in the patch's own (u, v).
struct JetWeights {
  std::array<double, 16> value, du, dv, duu, duv, dvv;
};

/// Sixteen weights, in the order of RegularPatch. (u, v) in the unit square.
void quad_jet_weights(double u, double v, JetWeights& weights);

/// Twelve weights, in the order of kTriangleLattice. u, v, 1 - u - v >= 0.
void triangle_jet_weights(double u, double v, JetWeights& weights);

inline void jet_weights(bool quads, double u, double v, JetWeights& weights) {
  if (quads) return quad_jet_weights(u, v, weights);
  triangle_jet_weights(u, v, weights);
}

/// The third derivatives likewise.
struct ThirdWeights {
  std::array<double, 16> duuu, duuv, duvv, dvvv;
};
void third_weights(bool quads, double u, double v, ThirdWeights& weights);

/// Four cubic basis functions with their derivatives.
struct CubicJet {
  double value[4], first[4], second[4];
};

/// Value, du, dv, duu, duv, dvv.
using PatchJet = std::array<Double4, 6>;

/// Of control points[rows[i]], without weights in between: along u, then along v.
void quad_jet(double u, double v, const Double4* points, const Index* rows, PatchJet& jet);
void triangle_jet(double u, double v, const Double4* points, const Index* rows, PatchJet& jet);
inline void patch_jet(bool quads, double u, double v, const Double4* points, const Index* rows, PatchJet& jet) {
  if (quads) return quad_jet(u, v, points, rows, jet);
  triangle_jet(u, v, points, rows, jet);
}

}  // namespace batten
