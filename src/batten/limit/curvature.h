/// \file Mean and Gaussian curvature of a surface from exact points and normals on it.
///
/// At a point, the normal changes along the surface by dn = S dp, where S is the shape operator in the tangent plane.
/// Here S is the symmetric 2-by-2 matrix that fits best, over the vertices of the faces around, what the normals do.
#pragma once
#include <Eigen/Core>

#include "batten/mesh/topology.h"
#include "batten/types.h"

namespace batten {

struct Curvature {
  Eigen::VectorXd mean;      ///< V, half the trace of S, 1/unit: 1/r on a sphere with outward normals
  Eigen::VectorXd gaussian;  ///< V, the determinant of S, 1/unit^2
};

/// points: V-by-3, on the surface. corner_normals: H-by-3, unit normals per half-edge at its origin, on its face's side
/// (LimitNormals::corners): faces on the other side of a crease do not count. At a vertex on a crease the result is
/// that of the side where its fan starts; NaN where there is no normal or no face that is not a hole.
///
/// The error falls with the square of the edges' length where the faces around are nearly symmetric (refined meshes
/// are, but at extraordinary vertices and boundaries, where it falls linearly). A Catmull-Clark or Loop surface itself
/// has no curvature at its extraordinary points: there numbers grow or drift from level to level.
/// O(H). Throws Error(BadShape).
Curvature estimate_curvature(const Topology& topology, ConstValuesRef points, ConstValuesRef corner_normals);

}  // namespace batten
