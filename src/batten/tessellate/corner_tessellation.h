/// \file Attributes at corners, texture coordinates above all, over the grids of a tessellation.
#pragma once
#include "batten/mesh/mesh.h"
#include "batten/tessellate/tessellation_layout.h"

namespace batten {

/// Linear within each base face, as refine_at_corners() is. Rows of the result: those of the attribute, then those
/// inside edges (twice where the sides differ), then those inside faces. A face with a corner that has no row has none
/// at all. Corners in the order of the tessellation's faces; face_rank as the Tessellator has it: the number of drawn
/// faces before each, -1 for one not drawn, empty where all are. Throws Error(BadShape, TooLarge).
Attribute tessellate_corners(const Topology& base, const TessellationLayout& layout, const Buffer<Index>& face_rank,
                             const Attribute& attribute);

}  // namespace batten
