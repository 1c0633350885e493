/// \file The limit of values at corners that are not linear within their faces, over a tessellation.
#pragma once
#include "batten/mesh/mesh.h"
#include "batten/mesh/topology.h"
#include "batten/progress.h"
#include "batten/scheme/scheme.h"

namespace batten {

/// The attribute at the corners of the faces of a Tessellator of so many levels on this topology and scheme, in its
/// order; with 0 levels at those of the mesh's own faces without holes. `topology` has the holes of the surface
/// (with_surface_holes). A face with a corner that has no row has none. O(result). Throws what face_varying_surface()
/// and Tessellator do.
Attribute face_varying_limit(const Topology& topology, const Scheme& scheme, const Attribute& attribute, int levels,
                             const Progress& progress = {});

}  // namespace batten
