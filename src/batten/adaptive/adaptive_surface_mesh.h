/// \file The limit surface as few faces as a tolerance allows, with everything that the control mesh has.
#pragma once
#include "batten/adaptive/adaptive.h"

namespace batten {

/// tessellate_adaptively() for a mesh with what it has beside its points, as surface_mesh() carries it
/// (tessellate/surface_mesh.h): attributes at the vertices follow their CarryRule, attributes at corners
/// scheme.face_varying, where all of a face's corners have a row, and a group has the faces that lie in its own. For
/// groups the faces are sorted by the faces of the control mesh that they lie in. Holes are left out, and so are tags,
/// since these points are no control points: the sides of a crease have normals of their own. O(result) for each
/// attribute. Throws what tessellate_adaptively() throws, and Error(BadShape, NotFinite, IndexOutOfRange) for
/// attributes and groups that do not fit.
AdaptiveMesh adaptive_surface_mesh(const Topology& topology, const Scheme& scheme, const Mesh& control,
                                   const AdaptiveOptions& options, const Progress& progress = {});

}  // namespace batten
