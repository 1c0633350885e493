/// \file The masks of Butterfly (Dyn, Gregory and Levin 1990, key DGL90) and Modified Butterfly (Zorin, Schroeder and
/// Sweldens 1996, key ZSS96), once.
///
/// Both make one new point an edge and keep the old ones. Around the edge v1 v2: the opposite vertices of its two
/// triangles, the wings across the triangles' other four sides, and the vertices beyond v1 and v2 in line with it.
/// Rules at boundaries after the notes of Zorin and Schroeder's course (key ZS00), corrected as in
/// docs/mathematics.md, Butterfly.
#pragma once
#include <vector>

#include "batten/scheme/masks.h"
#include "batten/scheme/scheme.h"

namespace batten {

/// Weights of the ten-point stencil: 2 end + 2 opposite + 4 wing + 2 beyond = 1.
struct ButterflyMask {
  double end;
  double opposite;
  double wing;
  double beyond;
};
/// scheme: one of the Butterflies. Cubic polynomials on the regular grid are reproduced at w = 1/16 of Butterfly and at
/// any w of Modified Butterfly.
ButterflyMask butterfly_mask(const Scheme& scheme);

/// Boundary and crease curves are the four-point scheme: (-1, 9, 9, -1)/16; exact for cubics.
inline constexpr double kFourPointNear = 9.0 / 16.0;
inline constexpr double kFourPointFar = -1.0 / 16.0;
/// Where the curve ends at one end: weights of that end, of the other and of the point after it. CreaseRules: the
/// parabola through the three, 6/16, 12/16, -2/16; Reflect: 7/16, 10/16, -1/16.
struct CurveEndMask {
  double end;
  double other;
  double after;
};
CurveEndMask curve_end_mask(ButterflyBoundary boundary);

/// The new point of an edge at a smooth vertex of valence K != 6: weights of the vertex (3/4) and of its neighbours
/// e_j, e_0 the edge's other end. K = 2: its middle.
RingMask extraordinary_mask(int valence);

/// The new point of edge i, 0 < i < k, at a vertex of a boundary or crease with k triangles on this side, k != 3:
/// weights of the vertex and of e_0 (the leading sharp edge) to e_k. Exact for 1, x, y on the ring of unit edges.
RingMask crease_vertex_mask(int triangles, int edge);

/// An edge with one wing missing, at v across side A (docs/mathematics.md, Butterfly); x is the other end. Exact for
/// quadratics.
struct OneWingMissing {
  double v = 6.0 / 16.0;
  double x = 10.0 / 16.0;
  double opposite_a = 1.0 / 16.0;
  double opposite_b = 3.0 / 16.0;
  double wing_v_b = -1.0 / 16.0;
  double wing_x_a = -1.0 / 16.0;
  double wing_x_b = -2.0 / 16.0;
};
/// An edge with both wings of side A missing: exact for quadratics.
struct SideMissing {
  double end = 0.5;
  double opposite_b = 0.25;
  double wing_b = -0.125;
};

/// Limit tangents of Modified Butterfly at a smooth vertex of valence K != 6 among regular ones, from the ring alone:
/// sum cos(2 pi j/K) e_j, sum sin(2 pi j/K) e_j. first x second points outward.
TangentMasks extraordinary_tangents(int valence);

/// Limit tangents across a boundary or crease with k triangles on this side. Modified Butterfly with CreaseRules,
/// k >= 2 and k != 3: sum sin(i pi/k) e_i - cot(pi/2k) v, inward.
RingMask crease_vertex_cross_tangent(int triangles);

/// The tangent of a curve of the four-point scheme: (1, -8, 0, 8, -1)/12 on five points in a row.
inline constexpr double kCurveTangentNear = 8.0 / 12.0;
inline constexpr double kCurveTangentFar = -1.0 / 12.0;

/// The masks of a scheme, those of the usual valences made once.
class ButterflyMasks {
 public:
  explicit ButterflyMasks(const Scheme& scheme);

  bool is_modified() const { return modified_; }
  ButterflyBoundary boundary() const { return boundary_; }
  const ButterflyMask& stencil() const { return stencil_; }
  const CurveEndMask& curve_end() const { return curve_end_; }
  /// `scratch` holds what is not tabulated.
  const RingMask& extraordinary(int valence, RingMask& scratch) const;
  const RingMask& crease_vertex(int triangles, int edge, RingMask& scratch) const;

 private:
  bool modified_;
  ButterflyBoundary boundary_;
  ButterflyMask stencil_;
  CurveEndMask curve_end_;
  std::vector<RingMask> extraordinary_;
  std::vector<std::vector<RingMask>> crease_;
};

}  // namespace batten
