#include "batten/nearest/distance_summary.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace batten {

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

DistanceSummary summarize_distances(const Scalars& distances, double tolerance) {
  DistanceSummary summary;
  std::vector<double> sizes(static_cast<std::size_t>(distances.size()));
  for (Eigen::Index i = 0; i < distances.size(); ++i) {
    const double size = std::abs(distances[i]);
    sizes[static_cast<std::size_t>(i)] = size;
    if (size > summary.max) {
      summary.max = size;
      summary.max_point = static_cast<Index>(i);
    }
    if (size <= tolerance) {
      ++summary.on_count;
    } else if (distances[i] < 0.0) {
      ++summary.inside_count;
      summary.most_inside = std::max(summary.most_inside, size);
    } else {
      ++summary.outside_count;
      summary.most_outside = std::max(summary.most_outside, size);
    }
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

std::vector<Index> farthest_points(const Scalars& distances, std::size_t most) {
  std::vector<Index> points(static_cast<std::size_t>(distances.size()));
  std::iota(points.begin(), points.end(), 0);
  most = std::min(most, points.size());
  const auto farther = [&](Index a, Index b) {
    const double x = std::abs(distances[a]);
    const double y = std::abs(distances[b]);
    return x != y ? x > y : a < b;
  };
  std::partial_sort(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(most), points.end(), farther);
  points.resize(most);
  return points;
}

std::vector<Index> sample_points(const Scalars& distances, Index most) {
  const auto count = static_cast<Index>(distances.size());
  std::vector<Index> drawn(static_cast<std::size_t>(count));
  std::iota(drawn.begin(), drawn.end(), 0);
  if (count <= most) return drawn;
  drawn = farthest_points(distances, static_cast<std::size_t>(most / 2));
  const double stride = 2.0 * count / most;
  for (Index i = 0; i < most / 2; ++i) drawn.push_back(static_cast<Index>(stride * i));
  std::sort(drawn.begin(), drawn.end());
  drawn.erase(std::unique(drawn.begin(), drawn.end()), drawn.end());
  return drawn;
}

}  // namespace batten
