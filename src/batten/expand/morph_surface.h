/// \file A morph of limit surfaces as an animated mesh.
#pragma once
#include "batten/expand/morph.h"
#include "batten/tessellate/moving_surface.h"

namespace batten {

/// The surface of the morph's base and the targets that are added to it. morph: of control points (k = 3). control:
/// their mesh, whose points are ignored. The surface is refined `levels` times. Since surfaces are linear in their
/// control points, points are exact at all times, apart from weights that are linear between `frames` + 1 even times
/// and the morph's knots; normals are exact at the knots. Throws what surface_mesh throws, and Error(BadArgument) for
/// frames below 1 or a duration of 0 or less.
MovingSurface morph_surface(const Topology& topology, const Scheme& scheme, const Mesh& control, const Morph& morph,
                            int levels, int frames, double seconds, const Progress& progress = {});

}  // namespace batten
