/// \file Mean curvature of a fine mesh, and how fair that makes it: for surfaces that have no second derivatives to
/// ask, and to measure different surfaces by one and the same rule.
///
/// After Meyer, Desbrun, Schroeder and Barr 2003 (key MDSB03): the cotangent Laplacian of the points over an area
/// around each vertex is twice the mean curvature times the normal. Faces are split as triangulate_face does.
#pragma once
#include "batten/mesh/topology.h"
#include "batten/progress.h"

namespace batten {

/// Row v belongs to vertex v.
struct DiscreteCurvature {
  Scalars mean;  ///< V, 1/unit: 1/r on a sphere with outward normals; NaN where it is left out
  Scalars area;  ///< V, unit^2: the mixed Voronoi areas of MDSB03, which cover the mesh once
};

/// The Laplacian's part along the area-weighted mean of the facets' normals, over twice the Voronoi area. That area is
/// taken whole where angles are obtuse too, unlike in MDSB03, since it makes x^2 + y^2 exact on every ring (at valence
/// 3 the mixed area is half of it, and so the curvature would be doubled); but never below half of the mixed area.
/// Second order in the edge length where the mesh is locally a lattice; at irregular vertices the error need not
/// vanish. Left out: vertices on boundaries and holes, on edges and at corners that the topology tags as sharp, and
/// those without an area. points: V-by-3. O(H), threaded. Throws Error: BadShape, NotFinite, Cancelled.
DiscreteCurvature discrete_curvature(const Topology& topology, ConstValuesRef points, const Progress& progress = {});

/// Integrals of the mean curvature H over a surface, free of its unit and its size: the smaller, the fairer.
struct Fairness {
  double bending = 0.0;    ///< integral of H^2 dA; a sphere of any size has 4 pi, the least of all closed surfaces
  double variation = 0.0;  ///< area * integral of |grad H|^2 dA; a sphere has 0
  double area = 0.0;       ///< of the whole mesh, unit^2
  Index left_out = 0;      ///< vertices without a curvature: they and the triangles at them count for nothing
};

/// curvature: of discrete_curvature() for the same mesh. H is linear on triangles for its gradient. Threaded, the same
/// bits for any number of threads. O(H). Throws Error: BadShape, Cancelled.
Fairness fairness(const Topology& topology, ConstValuesRef points, const DiscreteCurvature& curvature,
                  const Progress& progress = {});

}  // namespace batten
