/// \file Triangle meshes made coarser by edge collapses.
#pragma once
#include "batten/mesh/mesh.h"
#include "batten/progress.h"

namespace batten {

/// Collapses edges, those that move the surface least first, until `vertices` are left or none may go. The cost is the
/// area-weighted squared distance from the planes of the triangles that became one (Garland and Heckbert 1997, key
/// GH97) and, with a small weight, from their corners, which keeps triangles in flat places of similar size. No
/// collapse changes the topology (the link condition, Dey and others 1999, key DEGN99), turns a triangle over or
/// leaves a valence above 12. Boundaries keep their course. `mesh`: triangles that Topology accepts; tags are dropped.
/// O(F log F).
Mesh simplified(const Mesh& mesh, Index vertices, const Progress& progress = {});

/// Planes that a mesh shall lie in, one a sample: N-by-3 points, normals of length 1, and the area of each. A plane
/// counts at the twelve nearest vertices within `reach` of its sample, so that those beside an edge or a corner know
/// all of its sides.
struct SamplePlanes {
  const Points& points;
  const Points& normals;
  const Scalars& areas;
  double reach;
};

/// The same with the cost of the samples' planes, which the triangles of a contour cut off at sharp edges: vertices go
/// to where planes meet. O(F log F + N log F).
Mesh simplified(const Mesh& mesh, const SamplePlanes& planes, Index vertices, const Progress& progress = {});

}  // namespace batten
