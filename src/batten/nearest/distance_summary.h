/// \file What a set of distances amounts to: extremes, means, shares, a histogram.
#pragma once
#include <vector>

#include "batten/types.h"

namespace batten {

/// Of distances that are negative inside, or all positive.
struct DistanceSummary {
  double max = 0.0;  ///< of the sizes
  Index max_point = 0;
  double rms = 0.0;
  double mean = 0.0;    ///< of the sizes
  double median = 0.0;  ///< of the sizes, and so are the shares below
  double most_of_95 = 0.0;
  double most_of_99 = 0.0;
  double most_outside = 0.0;  ///< 0 where no point is
  double most_inside = 0.0;
  Index outside_count = 0;
  Index inside_count = 0;
  Index on_count = 0;  ///< neither: the size is within the tolerance
};

/// distances: one or more, finite; tolerance: what each may be wrong by (SurfaceDistances::tolerance). O(n).
DistanceSummary summarize_distances(const Scalars& distances, double tolerance = 0.0);

/// Bars of one width, which is 1, 2 or 5 times a power of ten; 0 is the edge of one.
struct Histogram {
  double start = 0.0;
  double width = 0.0;
  std::vector<Index> counts;
};
/// values: one or more, finite. At most `most_bars` bars; of equal numbers one.
Histogram histogram_of(const Scalars& values, int most_bars = 16);

/// The points that are farthest away, `most` of them or all, the farthest first; of equal ones the lower first.
std::vector<Index> farthest_points(const Scalars& distances, std::size_t most);

/// At most `most` points, in ascending order: half of them the farthest, the others spread evenly over all.
std::vector<Index> sample_points(const Scalars& distances, Index most);

}  // namespace batten
