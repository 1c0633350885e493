/// \file Polygons to triangles.
#pragma once
#include "batten/mesh/mesh.h"

namespace batten {

/// Splits every face into triangles, vertices kept: quads by the shorter diagonal, larger faces by cutting ears in the
/// plane of their average normal (a fan where no ear is found). Creases, corners and attributes stay; holes and groups
/// follow their faces. O(d^2) for a face of d corners. The faces must be valid (see Topology).
Mesh triangulated(const Mesh& mesh);

}  // namespace batten
