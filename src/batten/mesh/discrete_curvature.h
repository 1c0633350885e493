/// \file Mean curvature and fairness of a fine mesh: for surfaces without second derivatives, and for comparing
/// different surfaces by the same rule.
///
/// The method is that of Meyer, Desbrun, Schroeder and Barr 2003 (key MDSB03): the cotangent Laplacian of the points
/// over an area around each vertex is twice the mean curvature times the normal. Faces are split as triangulate_face
/// does.
#pragma once
#include "batten/mesh/topology.h"
#include "batten/progress.h"

namespace batten {

/// Row v belongs to vertex v.
struct DiscreteCurvature {
  Scalars mean;  ///< V, 1/unit: 1/r on a sphere with outward normals; NaN at vertices that are left out
  Scalars area;  ///< V, unit^2: the mixed Voronoi areas of MDSB03, which cover the mesh exactly once
};

/// The mean curvature is the Laplacian's component along the area-weighted mean of the facets' normals, divided by
/// twice the Voronoi area. Unlike MDSB03, this area stays the Voronoi area where angles are obtuse, which makes x^2 +
/// y^2 exact on every ring (at valence 3 the mixed area is half of it and would double the curvature); it is never less
/// than half of the mixed area. The error is of second order in the edge length where the mesh is locally a lattice; at
/// irregular vertices it need not vanish. Left out are vertices on boundaries and holes, on edges and at corners tagged
/// as sharp, and those without area. points: V-by-3. O(H), threaded. Throws Error: BadShape, NotFinite, Cancelled.
DiscreteCurvature discrete_curvature(const Topology& topology, ConstValuesRef points, const Progress& progress = {});

/// Integrals of the mean curvature H over a surface that do not depend on its unit or size. Smaller is fairer.
struct Fairness {
  double bending = 0.0;    ///< integral of H^2 dA; a sphere of any size has 4 pi, the least of all closed surfaces
  double variation = 0.0;  ///< area * integral of |grad H|^2 dA; a sphere has 0
  double area = 0.0;       ///< of the whole mesh, unit^2
  Index left_out = 0;      ///< vertices without a curvature; they and the triangles at them are not counted
};

/// curvature: that of discrete_curvature() for the same mesh. For the gradient, H is linear on each triangle. Threaded;
/// the result does not depend on the number of threads. O(H). Throws Error: BadShape, Cancelled.
Fairness fairness(const Topology& topology, ConstValuesRef points, const DiscreteCurvature& curvature,
                  const Progress& progress = {});

}  // namespace batten
