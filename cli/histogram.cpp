#include "cli/histogram.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cli/text.h"

namespace batten::cli {

std::vector<std::string> histogram_lines(const Histogram& histogram) {
  constexpr int kWidth = 40;
  const Index most = *std::max_element(histogram.counts.begin(), histogram.counts.end());
  const double all = std::accumulate(histogram.counts.begin(), histogram.counts.end(), 0.0);
  std::vector<std::string> starts;
  std::vector<std::string> ends;
  std::size_t longest = 0;
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    // A bar's ends are whole multiples of the width, so that zero is printed as zero.
    const double bar = std::round(histogram.start / histogram.width) + static_cast<double>(i);
    starts.push_back(fmt::format("{:.4g}", bar * histogram.width));
    ends.push_back(fmt::format("{:.4g}", (bar + 1.0) * histogram.width));
    longest = std::max({longest, starts.back().size(), ends.back().size()});
  }
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    const Index count = histogram.counts[i];
    const auto length = static_cast<std::size_t>(std::lround(static_cast<double>(kWidth) * count / most));
    const std::string bar(std::max<std::size_t>(length, count > 0 ? 1 : 0), '#');
    lines.push_back(fmt::format("{:>{}} to {:>{}}  {:<{}}  {:>6.2f} %  {}", starts[i], longest, ends[i], longest, bar,
                                kWidth, 100.0 * count / all, grouped(count)));
  }
  return lines;
}

nlohmann::ordered_json histogram_json(const Histogram& histogram) {
  return {{"start", histogram.start}, {"width", histogram.width}, {"counts", histogram.counts}};
}

}  // namespace batten::cli
