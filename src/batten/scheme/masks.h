/// \file The masks of Catmull-Clark and Loop: refinement, limit position, limit tangents. No other file repeats them.
///
/// A smooth mask around a vertex of valence n has a weight for the vertex, one for each edge neighbour e_j, and one for
/// each face. Under Catmull-Clark the face weight belongs to the face's centroid (refinement, limit position) or to its
/// quad corner f_j between e_j and e_{j+1} (tangents). Loop has no face weights. docs/mathematics.md has the formulas
/// and their sources.
#pragma once
#include <vector>

#include "batten/scheme/scheme.h"

namespace batten {

/// A mask with equal weights for all edges and equal weights for all faces.
struct SmoothMask {
  double vertex;
  double edge;
  double face;
};

/// The refined vertex. Catmull-Clark: v' = vertex v + edge sum e + face sum centroids, with weights (n-2)/n, 1/n^2,
/// 1/n^2 for alpha 0.
/// Loop: v' = vertex v + edge sum e, with edge = beta_n = (5/8 - (3/8 + cos(2 pi/n)/4)^2)/n.
SmoothMask vertex_mask(SchemeKind kind, int valence, double alpha = 0.0);

/// The limit position. Catmull-Clark, on centroids: [(n(n-1) + n alpha) v + (2 - alpha) sum e + 4 sum c]/(n(n+5)).
/// Loop: (w v + sum e)/(w + n), w = 3/(8 beta_n).
SmoothMask limit_mask(SchemeKind kind, int valence, double alpha = 0.0);

/// A smooth edge point: `end` is the weight of each end, `face` that of each side's centroid (Catmull-Clark) or
/// opposite vertex (Loop).
struct EdgeMask {
  double end;
  double face;
};
/// `triangles`: how many of the two faces are triangles. This matters under TriangleRule::Smooth only.
EdgeMask edge_mask(const Scheme& scheme, int triangles);

/// Crease and boundary curves are uniform cubic B-splines: v' = (a + 6 v + b)/8, limit (a + 4 v + b)/6.
inline constexpr double kCreaseVertex = 0.75;
inline constexpr double kCreaseNeighbour = 0.125;           ///< weight of each neighbour along the curve
inline constexpr double kCreaseLimitVertex = 4.0 / 6.0;     ///< weight in the limit position
inline constexpr double kCreaseLimitNeighbour = 1.0 / 6.0;  ///< weight of each neighbour in the limit position

/// Weights on a ring: the vertex, its edges counter-clockwise, and the quad corner after each edge.
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

/// The tangents of a smooth interior vertex, n >= 3; first points at e_0. Edge j has the weights A_n cos, A_n sin
/// (Catmull-Clark) or cos, sin (Loop) of the angle 2 pi j/n.
TangentMasks smooth_tangents(SchemeKind kind, int valence);

/// Which cross tangent to take at creases and boundaries.
enum class CreaseTangents {
  Exact,      ///< the limit of the rules in use, where it exists: k <= 3 faces (Catmull-Clark), k <= 5 (Loop)
  OpenSubdiv  ///< OpenSubdiv's masks for every k; beyond those bounds both choices are the same
};
/// Which limit masks to take where OpenSubdiv's masks are not the limit of the rules in use. Exact takes the limit.
/// OpenSubdiv takes the smooth mask at darts, and the vertex itself at interior vertices of valence 2.
enum class LimitMasks { Exact, OpenSubdiv };

/// The tangents at k >= 1 faces between two sharp edges e_0 (leading) and e_k: first runs along the curve, e_0 - e_k;
/// second runs across it.
TangentMasks crease_tangents(SchemeKind kind, int faces, CreaseTangents choice);

/// The factor by which a smooth vertex's ring shrinks at each level: the subdominant eigenvalue lambda_n.
double subdominant_eigenvalue(SchemeKind kind, int valence);

}  // namespace batten
