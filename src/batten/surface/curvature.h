/// \file Mean and Gaussian curvature of the limit surface at the vertices of a refined mesh.
#pragma once
#include "batten/buffer.h"
#include "batten/surface/limit_surface.h"

namespace batten {

/// Where the vertices of a refined mesh lie on the surface. refined: surface.base() after any number of Refinement
/// steps, or, where the base is the first of them, the control mesh itself. A vertex on a border between faces has its
/// place in the face where its fan starts; one without a face has face -1. O(V levels). Throws Error(BadShape) where
/// the face counts do not belong together.
Buffer<SurfacePlace> vertex_places(const LimitSurface& surface, const Topology& refined);

/// Row v belongs to vertex v of the refined mesh.
struct Curvature {
  Scalars mean;      ///< V, 1/unit: 1/r on a sphere with outward normals
  Scalars gaussian;  ///< V, 1/unit^2
};

/// Exact, by the surface's second derivatives; on a crease, that of the side where the vertex's fan starts. At
/// extraordinary vertices, where the surface has none, the mean over the neighbours that have one. NaN where nothing
/// does: no face, no normal. Threaded. Throws Error(BadShape) as vertex_places().
Curvature limit_curvature(const LimitSurface& surface, const Topology& refined);

}  // namespace batten
