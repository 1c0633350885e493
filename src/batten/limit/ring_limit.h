/// \file Limit masks of one vertex by its ring, whatever its tags: exact where OpenSubdiv's masks are not.
///
/// The ring of a vertex refines into itself: (v, e_j, f_j) at level L gives (v', e'_j, f'_j) at level L + 1 by a matrix
/// that depends on the sharpness around v alone. A mask on the finest ring is pulled back through these matrices to the
/// control ring: a handful of steps while semi-sharp tags fade, and repeated to a fixed point for a dart.
#pragma once
#include <vector>

#include "batten/refine/vertex_blend.h"
#include "batten/scheme/masks.h"

namespace batten {

/// What decides how a ring refines. In masks, `faces` are the quad corners f_j; a face of another size acts through
/// f_j := 4 c_j - v - e_j - e_{j+1} with its centroid c_j (docs/mathematics.md, Notation).
struct RingRules {
  SchemeKind kind = SchemeKind::CatmullClark;
  CreaseMethod crease_method = CreaseMethod::Uniform;
  bool closed = true;
  double alpha = 0.0;  ///< in the first step
  float vertex_sharpness = 0.0F;
  Buffer<float> sharpness;                ///< of the edges
  Buffer<float> outer_sharpness;          ///< of the child edge at the far end of each edge (Chaikin looks there)
  Buffer<std::uint8_t> smooth_triangles;  ///< per face: a triangle under TriangleRule::Smooth; empty for none

  int edge_count() const { return static_cast<int>(sharpness.size()); }
  int face_count() const { return edge_count() - (closed ? 0 : 1); }
};

RingRules ring_rules(const Topology& topology, const Scheme& scheme, double alpha, Index vertex, VertexRing& ring);

RingMask limit_position_mask(const RingRules& rules, LimitMasks choice);

/// The part of a ring between two sharp edges (or all of it), with one tangent plane.
struct RingSector {
  int first_face;
  int face_count;
  TangentMasks tangents;  ///< on the whole ring; all zero where there is no tangent plane
};
std::vector<RingSector> limit_sectors(const RingRules& rules, LimitMasks choice);

}  // namespace batten
