#include "batten/fit/belonging.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "batten/parallel/parallel.h"
#include "batten/quantile.h"

namespace batten {

namespace {

/// Calls use(j) for the neighbours of a point that are not far.
template <typename Use>
void for_near_neighbours(const CloudOdds& cloud, Index row, const Use& use) {
  const NeighbourTable& table = cloud.neighbours;
  for (Index k = 0; k < table.count && table.point(row, k) >= 0; ++k) {
    if (cloud.far[table.point(row, k)] == 0) use(table.point(row, k));
  }
}

/// The offsets of points beside those of their neighbours.
struct Differences {
  Scalars own;     ///< how far each is from the median of its neighbours'
  Scalars spread;  ///< the median of how far these are from it
};

/// Where most neighbours are far, nothing is known of the others, and each offset differs as a whole: outliers come in
/// pairs and threes, too.
Differences differences(const CloudOdds& cloud, const Points& offsets) {
  Differences found{Scalars(offsets.rows()), Scalars::Zero(offsets.rows())};
  parallel_for(offsets.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    std::vector<double> few;
    for (auto i = static_cast<Index>(begin); i < static_cast<Index>(end); ++i) {
      Eigen::RowVector3d usual = Eigen::RowVector3d::Zero();
      bool known = true;
      for (Index c = 0; c < 3 && known; ++c) {
        few.clear();
        for_near_neighbours(cloud, i, [&](Index other) { few.push_back(offsets(other, c)); });
        known = 2 * few.size() > static_cast<std::size_t>(cloud.neighbours.count);
        if (known) usual(c) = quantile(few, 0.5);
      }
      found.own(i) = (offsets.row(i) - usual).norm();
      if (!known) continue;
      few.clear();
      for_near_neighbours(cloud, i, [&](Index other) { few.push_back((offsets.row(other) - usual).norm()); });
      found.spread(i) = quantile(few, 0.5);
    }
  });
  return found;
}

/// Far points in a unit of volume of the box around all, which is no thinner than what far points keep from a surface.
double far_density(const CloudOdds& cloud) {
  const auto count = static_cast<double>(std::count(cloud.far.begin(), cloud.far.end(), std::uint8_t{1}));
  if (count == 0.0) return 0.0;
  constexpr double kThinnest = 3.0;
  const Eigen::RowVector3d sides = cloud.points.colwise().maxCoeff() - cloud.points.colwise().minCoeff();
  return count / sides.cwiseMax(kThinnest * cloud.spacing).prod();
}

/// The part of the surface that a point stands for.
double area_of(const NeighbourTable& neighbours, Index row) {
  Index last = neighbours.count;
  while (last > 0 && neighbours.point(row, last - 1) < 0) --last;
  if (last == 0) return 0.0;
  const double reach = neighbours.distance(row, last - 1);
  return std::numbers::pi * reach * reach / last;
}

}  // namespace

Scalars belonging(const CloudOdds& cloud, const Points& offsets) {
  // Few points alone say little about how much points differ: no less than half of what is usual everywhere.
  constexpr double kLeastOfUsual = 0.5;
  const double density = far_density(cloud);
  Scalars belong(offsets.rows());
  for (Eigen::Index i = 0; i < belong.size(); ++i) belong[i] = cloud.far[static_cast<std::size_t>(i)] != 0 ? 0.0 : 1.0;
  if (!(density > 0.0) || !std::isfinite(density)) return belong;
  const Differences differ = differences(cloud, offsets);
  std::vector<double> all;
  for (Eigen::Index i = 0; i < belong.size(); ++i) {
    if (belong[i] > 0.0) all.push_back(differ.own[i]);
  }
  if (all.empty()) return belong;
  const double least = kLeastOfUsual * quantile(all, 0.5);
  parallel_for(belong.size(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto i = static_cast<Index>(begin); i < static_cast<Index>(end); ++i) {
      // Neighbours differ by no more than their distance or so, however far the surface is: more is the way of
      // outliers.
      const double scale = std::min(std::max(least, differ.spread[i]), cloud.spacing);
      if (belong[i] == 0.0 || !(scale > 0.0)) continue;
      // Both are densities over the distance along the normal; differences fall off exponentially.
      const double inlier = 0.5 / scale * std::exp(-differ.own[i] / scale);
      const double outlier = density * area_of(cloud.neighbours, i);
      belong[i] = inlier / (inlier + outlier);
    }
  });
  return belong;
}

}  // namespace batten
