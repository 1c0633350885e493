/// \file The masks of Butterfly (Dyn, Gregory and Levin 1990, key DGL90) and Modified Butterfly (Zorin, Schroeder and
/// Sweldens 1996, key ZSS96).
///
/// Both schemes keep the old vertices and make one new point for each edge. The stencil of the edge v1 v2 has its ends,
/// the two vertices opposite it, the four wings (across the other sides of its two triangles) and the two vertices
/// beyond v1 and v2 in line with it. The rules at boundaries are those of Zorin and Schroeder's course notes (key
/// ZS00), corrected as docs/mathematics.md, Butterfly, says.
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
/// scheme: Butterfly or Modified Butterfly. Cubic polynomials on the regular grid are reproduced for w = 1/16 of
/// Butterfly and for any w of Modified Butterfly.
ButterflyMask butterfly_mask(const Scheme& scheme);

/// Boundary and crease curves follow the four-point scheme (-1, 9, 9, -1)/16, which is exact for cubics.
inline constexpr double kFourPointNear = 9.0 / 16.0;
inline constexpr double kFourPointFar = -1.0 / 16.0;
/// The new point of a curve's last edge: weights of the curve's end, of the edge's other end and of the point after
/// that. CreaseRules takes the parabola through the three, 6/16, 12/16, -2/16; Reflect takes 7/16, 10/16, -1/16.
struct CurveEndMask {
  double end;
  double other;
  double after;
};
CurveEndMask curve_end_mask(ButterflyBoundary boundary);

/// The new point of an edge at a smooth vertex of valence K != 6: weights of the vertex (3/4) and of its neighbours
/// e_j; e_0 is the edge's other end. For K = 2 the point is the midpoint.
RingMask extraordinary_mask(int valence);

/// The new point of edge i, 0 < i < k, at a vertex of a boundary or crease with k triangles on this side, k != 3:
/// weights of the vertex and of e_0 (the leading sharp edge) to e_k. Exact for the polynomials 1, x, y on the ring of
/// unit edges.
RingMask crease_vertex_mask(int triangles, int edge);

/// The new point of an edge v x whose stencil lacks the wing at v on side A (docs/mathematics.md, Butterfly). Exact for
/// quadratic polynomials.
struct OneWingMissing {
  double v = 6.0 / 16.0;
  double x = 10.0 / 16.0;
  double opposite_a = 1.0 / 16.0;
  double opposite_b = 3.0 / 16.0;
  double wing_v_b = -1.0 / 16.0;
  double wing_x_a = -1.0 / 16.0;
  double wing_x_b = -2.0 / 16.0;
};
/// The new point of an edge whose stencil lacks both wings of side A. Exact for quadratic polynomials.
struct SideMissing {
  double end = 0.5;
  double opposite_b = 0.25;
  double wing_b = -0.125;
};

/// Limit tangents of Modified Butterfly at a smooth vertex of valence K != 6 whose neighbours are regular: sum cos(2 pi
/// j/K) e_j and sum sin(2 pi j/K) e_j. first x second points outward.
TangentMasks extraordinary_tangents(int valence);

/// The limit tangent across a boundary or crease with k triangles on this side, for Modified Butterfly with
/// CreaseRules, k >= 2 and k != 3: sum sin(i pi/k) e_i - cot(pi/2k) v. It points inward.
RingMask crease_vertex_cross_tangent(int triangles);

/// The tangent of a curve of the four-point scheme is (1, -8, 0, 8, -1)/12 on five points in a row.
inline constexpr double kCurveTangentNear = 8.0 / 12.0;
inline constexpr double kCurveTangentFar = -1.0 / 12.0;

/// The masks of a scheme. Those of the usual valences are tabulated.
class ButterflyMasks {
 public:
  explicit ButterflyMasks(const Scheme& scheme);

  bool is_modified() const { return modified_; }
  ButterflyBoundary boundary() const { return boundary_; }
  const ButterflyMask& stencil() const { return stencil_; }
  const CurveEndMask& curve_end() const { return curve_end_; }
  /// The mask at this valence or span. `scratch` stores it if it is not tabulated.
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
