/// \file The connectivity of one refinement step, in closed form (after Dupuy and Vanhoey 2021, key DV21).
#pragma once
#include "batten/mesh/topology.h"
#include "batten/scheme/scheme.h"

namespace batten {

/// Throws Error(NotTriangles), naming a face, unless the scheme is Catmull-Clark or all faces are triangles.
void require_triangles(const Topology& topology, const Scheme& scheme);

Topology child_topology(const Topology& topology, const Scheme& scheme, const Progress& progress = {});

}  // namespace batten
