/// \file Values at the vertices, linear over the faces, at the vertices of a tessellation.
#pragma once
#include "batten/progress.h"
#include "batten/tessellate/tessellation_layout.h"

namespace batten {

/// values: a row for each vertex of the base. Returns one for each vertex of the layout: bilinear within quads, linear
/// within triangles, which is what CarryRule::Midpoint comes to. Throws Error(Cancelled).
Values linear_values(const Topology& base, const TessellationLayout& layout, ConstValuesRef values,
                     const Progress& progress = {});

}  // namespace batten
