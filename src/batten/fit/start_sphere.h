/// \file The sphere that a fit of a closed surface may start from.
#pragma once
#include "batten/mesh/mesh.h"

namespace batten {

/// The cube refined twice, 98 vertices and 96 quads (the start of Qin, Mandal and Vemuri 1998, key QMV98), or for Loop
/// the octahedron refined twice, 66 vertices and 128 triangles, and then as often as `vertices` allows, with its
/// vertices on the unit sphere.
Mesh unit_sphere(SchemeKind kind, Index vertices = 0);

/// The ellipsoid that fills the box around points along their principal axes.
struct PointEllipsoid {
  Eigen::Matrix3d axes;       ///< in columns, right-handed, the shortest first
  Eigen::RowVector3d middle;  ///< along the axes
  Eigen::RowVector3d half;    ///< of its width along each
};

/// points: N-by-3, finite; one or more. Axes along which the points have no width get a hundredth of the longest. O(N).
/// Throws Error(BadArgument) where all points are on one line.
PointEllipsoid ellipsoid_around(ConstValuesRef points);

/// The coarsest unit_sphere() as the ellipsoid around the points. Throws what ellipsoid_around() throws.
Mesh start_sphere(ConstValuesRef points, SchemeKind kind);

}  // namespace batten
