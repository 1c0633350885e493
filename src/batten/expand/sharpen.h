/// \file Detail made stronger.
#pragma once
#include "batten/expand/mesh_series.h"
#include "batten/expand/self_intersections.h"

namespace batten {

/// How to sharpen.
struct SharpenOptions {
  SeriesMatrix matrix = SeriesMatrix::Limit;
  int m = 1;  ///< the first power of E - A that is added, 1 or more: the larger, the finer the detail that grows
  int n = 3;  ///< the last one
  int passes = 1;
  double amount = 1.0;       ///< of what is added; Lai and Cheng's is 1
  double most_growth = 4.0;  ///< no detail becomes larger than so many times; the amount is lowered for it. 1 or more
  bool keep_boundary = false;
  bool check = true;  ///< look for faces that pass through each other
};

/// The points and what was done.
struct SharpenResult {
  Points points;        ///< V-by-3
  double amount = 0.0;  ///< the one that was taken
  double growth = 1.0;  ///< what the finest detail that a mesh could have grows by: (1 + amount (n - m + 1))^passes
  double moved = 0.0;   ///< root mean square
  double most_moved = 0.0;
  Index most_moved_vertex = -1;
  SelfIntersections before;  ///< in what was given
  SelfIntersections after;
  Index turned_faces = 0;  ///< by more than a right angle: folded over
};

/// Each pass adds amount (G^m + .. + G^n) T to the points T, G = E - A (Lai and Cheng 2006, section 6, key LC06). A
/// mode with the eigenvalue a grows by 1 + amount ((1-a)^m - (1-a)^(n+1)) / a a pass, at most by 1 + amount (n - m +
/// 1): iterated, the finest detail explodes, hence the bound. Noise is detail: denoise first. O(H) a pass. Throws
/// Error: NotTriangles, NotFinite, BadArgument (0 < m <= n, passes, amount, most_growth), Cancelled.
SharpenResult sharpen(const Topology& topology, const Scheme& scheme, ConstValuesRef points,
                      const SharpenOptions& options = {}, const Progress& progress = {});

}  // namespace batten
