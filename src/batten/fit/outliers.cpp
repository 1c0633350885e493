#include "batten/fit/outliers.h"

#include <algorithm>
#include <array>

#include "batten/parallel/parallel.h"
#include "batten/quantile.h"

namespace batten {

namespace {

constexpr Index kNeighbours = 8;
constexpr double kLonelyHere = 3.0;
constexpr double kLonelyAnywhere = 6.0;
constexpr double kFar = 8.0;
constexpr double kFarInSpacings = 1.5;

/// The median over a point's neighbours; 0 without any.
template <typename Number>
double median_around(const NeighbourTable& table, Index point, const Number& number) {
  std::array<double, kNeighbours> values{};
  std::ptrdiff_t count = 0;
  for (Index k = 0; k < table.count; ++k) {
    const Index other = table.point(point, k);
    if (other >= 0) values[static_cast<std::size_t>(count++)] = number(other);
  }
  if (count == 0) return 0.0;
  std::nth_element(values.begin(), values.begin() + count / 2, values.begin() + count);
  return values[static_cast<std::size_t>(count / 2)];
}

}  // namespace

OutlierFilter::OutlierFilter(const PointTree& tree, const Progress& progress)
    : neighbours_(find_neighbours(tree, kNeighbours, progress)), own_(static_cast<std::size_t>(tree.size()), 0.0) {
  Buffer<double> nearest(own_.size(), 0.0);
  for (Index i = 0; i < tree.size(); ++i) {
    Index count = 0;
    for (Index k = 0; k < neighbours_.count && neighbours_.point(i, k) >= 0; ++k) {
      own_[i] += neighbours_.distance(i, k);
      ++count;
    }
    if (count == 0) continue;
    own_[i] /= count;
    nearest[i] = neighbours_.distance(i, 0);
  }
  if (own_.empty()) return;
  Buffer<double> sorted = own_;
  usual_ = quantile(sorted, 0.5);
  spacing_ = quantile(nearest, 0.5);
}

Buffer<std::uint8_t> OutlierFilter::lonely() const {
  Buffer<std::uint8_t> flags(own_.size(), 0);
  parallel_for(static_cast<std::ptrdiff_t>(own_.size()), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto i = static_cast<Index>(begin); i < static_cast<Index>(end); ++i) {
      const double here = median_around(neighbours_, i, [&](Index other) { return own_[other]; });
      flags[i] = own_[i] > kLonelyHere * here || own_[i] > kLonelyAnywhere * usual_ ? 1 : 0;
    }
  });
  return flags;
}

void OutlierFilter::add_far(const Scalars& distances, Buffer<std::uint8_t>& flags) const {
  parallel_for(static_cast<std::ptrdiff_t>(own_.size()), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto i = static_cast<Index>(begin); i < static_cast<Index>(end); ++i) {
      if (!(distances[i] > kFarInSpacings * spacing_)) continue;
      if (distances[i] > kFar * median_around(neighbours_, i, [&](Index other) { return distances[other]; }))
        flags[i] = 1;
    }
  });
}

}  // namespace batten
