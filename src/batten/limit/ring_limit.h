/// \file Limit masks of one vertex from its ring, for any tags. They are exact where OpenSubdiv's masks are not.
///
/// The ring of a vertex refines into itself: (v, e_j, f_j) at level L gives (v', e'_j, f'_j) at level L + 1 by a matrix
/// that depends only on the sharpness around v. A mask on a finer ring is pulled back through these matrices to the
/// control ring: through as many as semi-sharp tags last, and for a dart repeatedly until it is stationary.
#pragma once
#include <vector>

#include "batten/refine/vertex_blend.h"
#include "batten/scheme/masks.h"

namespace batten {

/// Everything that decides how a ring refines. In masks, `faces` are the quad corners f_j. A face of another size and
/// centroid c_j acts as a quad with f_j := 4 c_j - v - e_j - e_{j+1} (docs/mathematics.md, Notation).
struct RingRules {
  SchemeKind kind = SchemeKind::CatmullClark;
  CreaseMethod crease_method = CreaseMethod::Uniform;
  bool closed = true;
  double alpha = 0.0;  ///< Lai and Cheng's alpha in the first step
  float vertex_sharpness = 0.0F;
  Buffer<float> sharpness;        ///< one for each edge
  Buffer<float> outer_sharpness;  ///< of the child edge at each edge's far end, which Chaikin's rule needs
  /// One for each face: 1 for a triangle under TriangleRule::Smooth. Empty if there are none.
  Buffer<std::uint8_t> smooth_triangles;

  int edge_count() const { return static_cast<int>(sharpness.size()); }
  int face_count() const { return edge_count() - (closed ? 0 : 1); }
};

RingRules ring_rules(const Topology& topology, const Scheme& scheme, double alpha, Index vertex, VertexRing& ring);

RingMask limit_position_mask(const RingRules& rules, LimitMasks choice);

/// The part of a ring between two sharp edges, or the whole ring, with one tangent plane.
struct RingSector {
  int first_face;
  int face_count;
  TangentMasks tangents;  ///< on the whole ring; all zero if there is no tangent plane
};
std::vector<RingSector> limit_sectors(const RingRules& rules, LimitMasks choice);

}  // namespace batten
