#include "cli/distance_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cli/common.h"

namespace batten::cli {

namespace {

/// The value that a share of the sizes does not exceed.
double quantile(std::vector<double>& sizes, double share) {
  const auto place = static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(sizes.size()))) - 1;
  const auto at = sizes.begin() + std::max<std::ptrdiff_t>(place, 0);
  std::nth_element(sizes.begin(), at, sizes.end());
  return *at;
}

/// 1, 2 or 5 times a power of ten, and not below the width.
double round_width(double width) {
  const double power = std::pow(10.0, std::floor(std::log10(width)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * power >= width) return step * power;
  }
  return 10.0 * power;
}

}  // namespace

DistanceSummary summarize(const Scalars& distances) {
  DistanceSummary summary;
  std::vector<double> sizes(static_cast<std::size_t>(distances.size()));
  for (Eigen::Index i = 0; i < distances.size(); ++i) {
    const double size = std::abs(distances[i]);
    sizes[static_cast<std::size_t>(i)] = size;
    if (size > summary.max) {
      summary.max = size;
      summary.max_point = static_cast<Index>(i);
    }
    summary.most_outside = std::max(summary.most_outside, distances[i]);
    summary.most_inside = std::max(summary.most_inside, -distances[i]);
    summary.inside_count += distances[i] < 0.0 ? 1 : 0;
  }
  const auto count = static_cast<double>(sizes.size());
  summary.rms = std::sqrt(distances.squaredNorm() / count);
  summary.mean = std::accumulate(sizes.begin(), sizes.end(), 0.0) / count;
  summary.median = quantile(sizes, 0.5);
  summary.most_of_95 = quantile(sizes, 0.95);
  summary.most_of_99 = quantile(sizes, 0.99);
  return summary;
}

Histogram histogram_of(const Scalars& values, int most_bars) {
  Histogram histogram;
  const double low = std::min(values.minCoeff(), 0.0);
  const double high = std::max(values.maxCoeff(), 0.0);
  // Zero is an edge: two bars may be half empty.
  histogram.width = high > low ? round_width((high - low) / (most_bars - 2)) : 1.0;
  const double first = std::floor(low / histogram.width);
  histogram.start = first * histogram.width;
  const auto bars = static_cast<std::size_t>(std::floor(high / histogram.width) - first) + 1;
  histogram.counts.assign(bars, 0);
  for (const double value : values) {
    const double bar = std::floor(value / histogram.width) - first;
    ++histogram.counts[std::min(static_cast<std::size_t>(bar), bars - 1)];
  }
  return histogram;
}

std::vector<std::string> histogram_lines(const Histogram& histogram) {
  constexpr int kWidth = 40;
  const Index most = *std::max_element(histogram.counts.begin(), histogram.counts.end());
  const double all = std::accumulate(histogram.counts.begin(), histogram.counts.end(), 0.0);
  std::vector<std::string> starts;
  std::vector<std::string> ends;
  std::size_t longest = 0;
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    // Counted in whole widths, so that zero is zero.
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
