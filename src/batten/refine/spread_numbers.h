/// \file Numbers at some vertices of a mesh, as values at all vertices of a refined one.
#pragma once
#include "batten/mesh/topology.h"

namespace batten {

/// numbers: one for each of the first vertices of `topology`, such as those of the mesh that it was refined from; NaN
/// for none. Vertices without a number get the mean of their neighbours', in three rounds: those that one refinement
/// made get theirs on edges, then in faces, then beside these. After that they are refined linearly over the faces
/// until there are `count`. A vertex that is too far from any number stays NaN. O(count). Throws Error(NotTriangles).
Scalars spread_numbers(const Scalars& numbers, const Topology& topology, SchemeKind kind, Index count);

}  // namespace batten
