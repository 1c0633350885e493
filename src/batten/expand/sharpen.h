/// \file Amplifies the detail of a mesh.
#pragma once
#include "batten/expand/mesh_series.h"
#include "batten/mesh/self_intersections.h"

namespace batten {

/// Options of sharpen.
struct SharpenOptions {
  SeriesMatrix matrix = SeriesMatrix::Limit;
  int m = 1;  ///< the first power of E - A that is added, at least 1; a larger m amplifies finer detail
  int n = 3;  ///< the last power
  int passes = 1;
  double amount = 1.0;       ///< the factor of what is added; Lai and Cheng's is 1
  double most_growth = 4.0;  ///< the largest factor of any detail, at least 1; the amount is reduced to respect it
  bool keep_boundary = false;
  bool check = true;  ///< look for faces that pass through each other
};

/// The result of sharpen.
struct SharpenResult {
  Points points;        ///< V-by-3
  double amount = 0.0;  ///< the amount used
  double growth = 1.0;  ///< the factor of the finest possible detail: (1 + amount (n - m + 1))^passes
  double moved = 0.0;   ///< root mean square of the vertices' movement
  double most_moved = 0.0;
  Index most_moved_vertex = -1;
  SelfIntersections before;  ///< of the input
  SelfIntersections after;
  Index turned_faces = 0;  ///< faces that turned by more than a right angle and are folded
};

/// Each pass adds amount (G^m + .. + G^n) T to the points T, with G = E - A (Lai and Cheng 2006, section 6, key LC06).
/// A pass multiplies a mode of eigenvalue a by 1 + amount ((1-a)^m - (1-a)^(n+1)) / a, at most by 1 + amount (n - m +
/// 1). Repeated passes amplify the finest detail exponentially, which most_growth limits. Noise is detail too and
/// should be removed first. O(H) for each pass. Throws Error: NotTriangles, NotFinite, BadArgument (0 < m <= n, passes,
/// amount, most_growth), Cancelled.
SharpenResult sharpen(const Topology& topology, const Scheme& scheme, ConstValuesRef points,
                      const SharpenOptions& options = {}, const Progress& progress = {});

}  // namespace batten
