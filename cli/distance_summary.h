/// \file What a set of distances amounts to: extremes, means, shares, a histogram.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "batten/types.h"

namespace batten::cli {

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
  Index inside_count = 0;
};
/// Not empty. O(n).
DistanceSummary summarize(const Scalars& distances);

/// Bars of one width, which is 1, 2 or 5 times a power of ten; 0 is the edge of one.
struct Histogram {
  double start = 0.0;
  double width = 0.0;
  std::vector<Index> counts;
};
/// At most so many bars; of equal numbers one.
Histogram histogram_of(const Scalars& values, int most_bars = 16);
/// One line a bar.
std::vector<std::string> histogram_lines(const Histogram& histogram);
nlohmann::ordered_json histogram_json(const Histogram& histogram);

}  // namespace batten::cli
