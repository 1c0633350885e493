#include "batten/fit/outliers.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "batten/fit/orientation.h"
#include "batten/parallel/parallel.h"
#include "batten/quantile.h"

namespace batten {

namespace {

constexpr Index kSpacingNeighbours = 6;
constexpr double kFar = 8.0;
constexpr double kFarInSpacings = 1.5;

double median_neighbour(const Scalars& numbers, const NeighbourTable& neighbours, Index row, std::vector<double>& few) {
  few.clear();
  for (Index k = 0; k < neighbours.count && neighbours.point(row, k) >= 0; ++k)
    few.push_back(numbers(neighbours.point(row, k)));
  return quantile(few, 0.5);
}

/// One flag a point, 0 for lonely ones.
std::vector<std::uint8_t> not_lonely(const Points& points, const NeighbourTable& neighbours, const Scalars& spacing) {
  constexpr double kRough = 0.06;
  std::vector<std::uint8_t> kept(static_cast<std::size_t>(spacing.size()), 1);
  std::vector<double> few(spacing.data(), spacing.data() + spacing.size());
  const double typical = quantile(few, 0.5);
  const Scalars roughness = local_planes(points, neighbours).roughness;
  for (Index row = 0; row < static_cast<Index>(spacing.size()); ++row) {
    const double near = median_neighbour(spacing, neighbours, row, few);
    const bool rough = roughness(row) > kRough;
    const bool alone = spacing(row) > 2.2 * near && (rough || spacing(row) > 4.0 * near);
    if (alone || (rough && spacing(row) > 2.5 * typical)) kept[row] = 0;
  }
  return kept;
}

}  // namespace

Scalars spacing_of(const NeighbourTable& neighbours, Index size) {
  Scalars spacing(size);
  for (Index row = 0; row < size; ++row) {
    double sum = 0.0;
    Index count = 0;
    for (; count < kSpacingNeighbours && neighbours.point(row, count) >= 0; ++count)
      sum += neighbours.distance(row, count);
    spacing(row) = sum / std::max<Index>(count, 1);
  }
  return spacing;
}

OutlierFilter::OutlierFilter(const Points& points, const Progress& progress)
    : neighbours_(find_neighbours(PointTree(points), kCloudNeighbours, progress)),
      lonely_(static_cast<std::size_t>(points.rows()), 0) {
  Buffer<double> nearest;
  for (Index i = 0; i < static_cast<Index>(points.rows()); ++i) {
    if (neighbours_.point(i, 0) >= 0) nearest.push_back(neighbours_.distance(i, 0));
  }
  if (!nearest.empty()) spacing_ = quantile(nearest, 0.5);
  find_lonely(points);
}

void OutlierFilter::find_lonely(const Points& points) {
  constexpr int kRounds = 3;
  constexpr std::size_t kFewest = 50;
  std::vector<Index> rows(lonely_.size());
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<Index>(i);
  for (int round = 0; round < kRounds && rows.size() >= kFewest; ++round) {
    const Points left = points(rows, Eigen::all);
    const auto size = static_cast<Index>(rows.size());
    const NeighbourTable among = round == 0 ? neighbours_ : find_neighbours(PointTree(left), kCloudNeighbours);
    const std::vector<std::uint8_t> kept = not_lonely(left, among, spacing_of(among, size));
    const auto count = std::count(kept.begin(), kept.end(), 1);
    if (count == size || count < size / 2) break;
    std::vector<Index> next;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (kept[i] != 0) {
        next.push_back(rows[i]);
      } else {
        lonely_[rows[i]] = 1;
      }
    }
    rows = std::move(next);
  }
}

void OutlierFilter::add_far(const Scalars& distances, Buffer<std::uint8_t>& flags) const {
  parallel_for(static_cast<std::ptrdiff_t>(lonely_.size()), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    std::vector<double> around;
    for (auto i = static_cast<Index>(begin); i < static_cast<Index>(end); ++i) {
      if (!(distances[i] > kFarInSpacings * spacing_)) continue;
      around.clear();
      for (Index k = 0; k < neighbours_.count && neighbours_.point(i, k) >= 0; ++k) {
        const Index other = neighbours_.point(i, k);
        if (lonely_[other] == 0) around.push_back(distances[other]);
      }
      if (around.empty() || distances[i] > kFar * quantile(around, 0.5)) flags[i] = 1;
    }
  });
}

}  // namespace batten
