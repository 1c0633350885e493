/// \file The rule at a vertex in one refinement step, with creases, corners and the fading of sharpness.
#pragma once
#include "batten/mesh/topology.h"
#include "batten/scheme/scheme.h"
#include "batten/scheme/sharpness.h"

namespace batten {

/// v' = smooth (smooth mask) + crease (a + 6 v + b)/8 + corner v; the three weights sum to 1.
struct VertexBlend {
  double smooth = 1.0;
  double crease = 0.0;
  double corner = 0.0;
  Index crease_a = -1;  ///< the two neighbours along the crease, where crease > 0
  Index crease_b = -1;
};

/// The sharpness at which a step starts: the tag, or infinite at a single-face boundary vertex under EdgeAndCorner.
float vertex_sharpness(const Topology& topology, const Scheme& scheme, Index vertex);

/// The edges of a vertex with faces, counter-clockwise from the start of its fan.
struct VertexRing {
  Buffer<Index> edges;
  Buffer<Index> neighbours;
  Buffer<float> sharpness;  ///< one for each edge
  Buffer<Index> corners;    ///< outgoing half-edges; one fewer than edges at a boundary
  bool closed = true;
};
void gather_ring(const Topology& topology, Index vertex, VertexRing& ring);

/// The sharpness of the children of the ring's edges at this vertex.
Buffer<float> child_sharpness(const VertexRing& ring, CreaseMethod method);

/// True where both halves of a semi-sharp edge are still sharp after a step.
bool edge_stays_sharp(const Topology& topology, CreaseMethod method, Index edge);

/// The rule at this vertex for all levels to come, or for this step while the sharpness is still fading.
VertexRule vertex_rule_of(const Topology& topology, const Scheme& scheme, Index vertex, VertexRing& ring);

/// True if the topology has no tags, so that the smooth or boundary rules hold at every vertex.
bool is_untagged(const Topology& topology);

VertexBlend vertex_blend(const Topology& topology, const Scheme& scheme, Index vertex, VertexRing& ring);

/// The same from a ring alone. Here crease_a and crease_b are positions in the ring.
VertexBlend ring_blend(float vertex_sharpness, std::span<const float> sharpness, CreaseMethod method);

}  // namespace batten
