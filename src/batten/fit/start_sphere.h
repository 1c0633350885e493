/// \file The sphere that a fit of a closed surface may start from.
#pragma once
#include "batten/mesh/mesh.h"

namespace batten {

/// The cube refined twice, 98 vertices and 96 quads (the start of Qin, Mandal and Vemuri 1998, key QMV98), or for Loop
/// the octahedron refined twice, 66 vertices and 128 triangles: as an ellipsoid that fills the box around the points
/// along their principal axes. points: N-by-3, finite; one or more. Axes along which the points have no width get a
/// hundredth of the longest; where all points are equal the result is a point. O(N).
Mesh start_sphere(ConstValuesRef points, SchemeKind kind);

}  // namespace batten
