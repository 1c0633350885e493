/// \file A limit surface whose control points move, as the morph targets of one mesh.
#pragma once
#include <span>
#include <vector>

#include "batten/mesh/mesh.h"
#include "batten/mesh/morph_targets.h"
#include "batten/mesh/topology.h"
#include "batten/scheme/scheme.h"

namespace batten {

/// surface_mesh() of a control mesh, and what changes when its control points move: displacements and normals of each
/// shape; times and weights are left to the caller.
struct MovingSurface {
  Mesh mesh;
  MorphTargets targets;
};

/// control: the mesh at its first place. shapes: other control points, V-by-3 each; target i is the surface of
/// shapes[i] less that of `control`. Throws what surface_mesh() throws.
MovingSurface moving_surface(const Topology& topology, const Scheme& scheme, const Mesh& control,
                             std::span<const Points> shapes, int levels, const Progress& progress = {});

/// A surface that goes through shapes in time: at times[0] it is that of `control`, at times[i] that of shapes[i - 1],
/// and linear between them. Throws also Error(BadShape) unless there is a time more than shapes.
MovingSurface surface_through_time(const Topology& topology, const Scheme& scheme, const Mesh& control,
                                   std::span<const Points> shapes, std::vector<double> times, int levels,
                                   const Progress& progress = {});

}  // namespace batten
