/// \file The limit at one vertex as weights of its ring, for every kind of vertex.
#pragma once
#include <algorithm>

#include "batten/limit/ring_limit.h"

namespace batten {

/// Which quantity a tessellation computes.
enum class TileValue {
  Refined,  ///< the control points after the refinement steps
  Limit,    ///< the limit positions of those points
  TangentU,
  TangentV
};

inline bool is_tangent(TileValue value) { return value == TileValue::TangentU || value == TileValue::TangentV; }

/// Calls visit(vertex, weight) for the limit position at the half-edge's origin, or for one of two tangents that span
/// the tangent plane on the half-edge's side. For meshes of quads or of triangles only.
template <typename Visit>
void visit_vertex_limit(const Topology& topology, const Scheme& scheme, TileValue value, Index half_edge,
                        const Visit& visit) {
  const Index v = topology.origin(half_edge);
  VertexRing ring;
  const RingRules rules = ring_rules(topology, scheme, 0.0, v, ring);
  RingMask mask;
  if (value == TileValue::Limit) {
    mask = limit_position_mask(rules, LimitMasks::Exact);
  } else {
    const auto place = std::find(ring.corners.begin(), ring.corners.end(), half_edge) - ring.corners.begin();
    for (const RingSector& sector : limit_sectors(rules, LimitMasks::Exact)) {
      const auto faces = static_cast<std::ptrdiff_t>(ring.corners.size());
      if ((place - sector.first_face + faces) % faces >= sector.face_count) continue;
      mask = value == TileValue::TangentU ? sector.tangents.first : sector.tangents.second;
    }
  }
  visit(v, mask.vertex);
  for (std::size_t i = 0; i < mask.edges.size(); ++i) visit(ring.neighbours[i], mask.edges[i]);
  for (std::size_t i = 0; i < mask.faces.size(); ++i) {
    visit(topology.origin(topology.next(topology.next(ring.corners[i]))), mask.faces[i]);
  }
}

}  // namespace batten
