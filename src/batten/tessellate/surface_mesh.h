/// \file The limit surface as an ordinary mesh, for programs and formats that know no subdivision surfaces.
#pragma once
#include "batten/mesh/mesh.h"
#include "batten/mesh/topology.h"
#include "batten/scheme/scheme.h"

namespace batten {

/// The control mesh refined `levels` times, its points and its attributes at the vertices moved to the limit surface.
/// "normal" holds the exact limit normals at the vertices; where the surface has creases also at the corners, one row a
/// side (zero where there is no normal). Attributes at corners are interpolated linearly within their faces. Holes are
/// left out, and so are the tags: these points are on the surface, not control points of it. Vertex i of the control
/// mesh is vertex i. O(4^levels H). Throws what refine_mesh throws.
Mesh surface_mesh(const Topology& topology, const Scheme& scheme, const Mesh& control, int levels,
                  const Progress& progress = {});

}  // namespace batten
