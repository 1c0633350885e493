/// \file The masks of Catmull-Clark and Loop, once: refinement, limit position, limit tangents.
///
/// A smooth mask around a vertex of valence n has a weight for the vertex, one for each edge neighbour e_j, and one for
/// each face: for Catmull-Clark the face's centroid (refinement, limit position) or its quad corner f_j between e_j and
/// e_{j+1} (tangents). Loop has no face weights. docs/mathematics.md has the
/// formulas and their sources.
#pragma once
#include <vector>

#include "batten/scheme/scheme.h"

namespace batten {

/// Equal weights on all edges and on all faces.
struct SmoothMask {
  double vertex;
  double edge;
  double face;
};

/// Catmull-Clark: v' = vertex v + edge sum e + face sum centroids, with alpha 0: (n-2)/n, 1/n^2, 1/n^2.
/// Loop: v' = vertex v + edge sum e, beta_n = (5/8 - (3/8 + cos(2 pi/n)/4)^2)/n.
SmoothMask vertex_mask(SchemeKind kind, int valence, double alpha = 0.0);

/// The limit position. Catmull-Clark, on centroids: [(n(n-1) + n alpha) v + (2 - alpha) sum e + 4 sum c]/(n(n+5)).
/// Loop: (w v + sum e)/(w + n), w = 3/(8 beta_n).
SmoothMask limit_mask(SchemeKind kind, int valence, double alpha = 0.0);

/// A smooth edge point: `end` for each end; `face` for each side's centroid (Catmull-Clark) or opposite vertex (Loop).
struct EdgeMask {
  double end;
  double face;
};
/// `triangles`: how many of the two faces are triangles (they matter under TriangleRule::Smooth only, as OpenSubdiv's).
EdgeMask edge_mask(const Scheme& scheme, int triangles);

/// Crease and boundary curves are uniform cubic B-splines: v' = (a + 6 v + b)/8, limit (a + 4 v + b)/6.
inline constexpr double kCreaseVertex = 0.75;
inline constexpr double kCreaseNeighbour = 0.125;           ///< of each neighbour along the curve
inline constexpr double kCreaseLimitVertex = 4.0 / 6.0;     ///< in the limit
inline constexpr double kCreaseLimitNeighbour = 1.0 / 6.0;  ///< in the limit, of each neighbour

/// Weights on a ring: the vertex, its edges counter-clockwise, and the quad corners after each edge.
struct RingMask {
  double vertex = 0.0;
  std::vector<double> edges;
  std::vector<double> faces;
};
/// Two tangents that span the limit tangent plane; first x second points outward for counter-clockwise faces.
struct TangentMasks {
  RingMask first;
  RingMask second;
};

/// Smooth interior vertex, n >= 3: first points at e_0. The scale is A_n e_j + ... (Catmull-Clark), cos, sin (Loop).
TangentMasks smooth_tangents(SchemeKind kind, int valence);

/// Which cross tangent to take at creases and boundaries.
enum class CreaseTangents {
  Exact,      ///< the limit of the rules refined with, where one exists: k <= 3 faces (Catmull-Clark), k <= 5 (Loop)
  OpenSubdiv  ///< its masks for every k; beyond the bounds above both choices are the same
};
/// Which limit masks to take where OpenSubdiv's are not the limit of the rules refined with.
/// Darts: exact, or the smooth mask as in OpenSubdiv; valence 2: exact, or the vertex itself as in OpenSubdiv.
enum class LimitMasks { Exact, OpenSubdiv };

/// A span of k >= 1 faces between two sharp edges e_0 (leading) and e_k: first = along e_0 - e_k, second = across.
TangentMasks crease_tangents(SchemeKind kind, int faces, CreaseTangents choice);

/// The rate at which a smooth vertex's ring shrinks: the subdominant eigenvalue lambda_n.
double subdominant_eigenvalue(SchemeKind kind, int valence);

}  // namespace batten
