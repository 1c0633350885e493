/// \file Open edges that lie on each other, as in files that give each face vertices of its own.
#pragma once
#include "batten/mesh/topology.h"

namespace batten {

/// The number of vertices on seams whose coordinates equal those of an earlier vertex there. A seam is an open edge
/// both of whose ends lie where those of another open edge lie; a surface stays open along it. Welding (mesh/repair.h)
/// would join these vertices, except where that makes no surface. points: V-by-3. O(V + E) expected, without memory
/// where the mesh is closed.
Index coincident_boundary_count(const Topology& topology, const Points& points);

}  // namespace batten
