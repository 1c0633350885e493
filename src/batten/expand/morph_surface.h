/// \file A morph of limit surfaces as an animated mesh.
#pragma once
#include "batten/expand/morph.h"
#include "batten/mesh/morph_targets.h"

namespace batten {

/// The surface of a morph's base and the targets that are added to it.
struct MorphSurface {
  Mesh mesh;  ///< surface_mesh() of the base
  MorphTargets targets;
};

/// morph: of control points (k = 3). control: their mesh, whose points are ignored. The surface is refined `levels`
/// times. Since surfaces are linear in their control points, points are exact at all times, apart from weights that are
/// linear between `frames` + 1 even times and the morph's knots; normals are exact at the knots.
/// Throws what surface_mesh throws, and Error(BadArgument) for frames below 1 or a duration of 0 or less.
MorphSurface morph_surface(const Topology& topology, const Scheme& scheme, const Mesh& control, const Morph& morph,
                           int levels, int frames, double seconds, const Progress& progress = {});

}  // namespace batten
