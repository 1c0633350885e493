/// \file Numbers at a mesh's vertices, and on the surface between them.
#pragma once
#include "batten/mesh/topology.h"
#include "batten/scheme/scheme.h"

namespace batten::cli {

/// Edges at each vertex; at a boundary twice the faces, so that a regular vertex has 4 (Catmull-Clark) or 6 (Loop).
Scalars valences(const Topology& topology);

/// The largest sharpness at each vertex: of its inner edges and its own; 10 stands for an infinite one.
Scalars sharpnesses(const Topology& topology);

/// From a level's vertices to the next one's: vertices keep their number, new ones have the mean of their edge or face.
Scalars spread(const Topology& topology, SchemeKind kind, const Scalars& field);

/// As spread, but off the sharp edges of level 0 new vertices have zero: creases stay lines. At level 0 an edge has its
/// own sharpness; at level 1 (even_count: the vertices of level 0) halves of edges run from an even vertex to another.
Scalars spread_creases(const Topology& topology, SchemeKind kind, const Scalars& field, int level, Index even_count);

}  // namespace batten::cli
