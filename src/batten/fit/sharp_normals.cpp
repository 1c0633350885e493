#include "batten/fit/sharp_normals.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// How much a normal differs from those of the neighbours: the mean of 1 - cos.
double disagreement(const Points& normals, const NeighbourTable& neighbours, Index point) {
  double sum = 0.0;
  Index count = 0;
  for (Index k = 0; k < neighbours.count && neighbours.point(point, k) >= 0; ++k, ++count)
    sum += 1.0 - normals.row(point).dot(normals.row(neighbours.point(point, k)));
  return count > 0 ? sum / count : 0.0;
}

/// The neighbour whose normal the point takes, or the point itself.
Index most_even(const Points& points, const Points& normals, const Scalars& uneven, const NeighbourTable& neighbours,
                Index point) {
  constexpr double kOffPlane = 0.5;
  constexpr double kMuch = 2.0;
  constexpr double kLeastUneven = 0.01;
  double spacing = 0.0;
  Index count = 0;
  for (; count < neighbours.count && neighbours.point(point, count) >= 0; ++count)
    spacing += neighbours.distance(point, count);
  if (count == 0 || !(spacing > 0.0) || uneven[point] < kLeastUneven) return point;
  spacing /= count;
  Index best = point;
  double least = uneven[point] / kMuch;
  for (Index k = 0; k < count; ++k) {
    const Index other = neighbours.point(point, k);
    if (normals.row(other).dot(normals.row(point)) <= 0.0) continue;
    const double off = (points.row(point) - points.row(other)).dot(normals.row(other)) / spacing;
    const double score = uneven[other] + kOffPlane * off * off;
    if (score >= least) continue;
    least = score;
    best = other;
  }
  return best;
}

/// The mean normal of those neighbours on one side in whose planes the point lies best, or the point's own.
Eigen::RowVector3d best_side(const Points& points, const Points& normals, const NeighbourTable& neighbours,
                             Index point) {
  constexpr double kSameSide = 0.9;
  constexpr double kOpposite = -0.5;
  constexpr Index kLeast = 3;
  Eigen::RowVector3d best = normals.row(point);
  double least = std::numeric_limits<double>::infinity();
  Index count = 0;
  while (count < neighbours.count && neighbours.point(point, count) >= 0) ++count;
  for (Index k = 0; k < count; ++k) {
    const Eigen::RowVector3d side = normals.row(neighbours.point(point, k));
    if (side.dot(normals.row(point)) <= kOpposite) continue;
    double off = 0.0;
    Index same = 0;
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (Index m = 0; m < count; ++m) {
      const Index other = neighbours.point(point, m);
      if (normals.row(other).dot(side) < kSameSide) continue;
      off += std::abs((points.row(point) - points.row(other)).dot(normals.row(other)));
      sum += normals.row(other);
      ++same;
    }
    if (same < kLeast || !(off < least * same)) continue;
    least = off / same;
    best = sum.normalized();
  }
  return best;
}

}  // namespace

Points sharp_normals(const Points& points, Points normals, const NeighbourTable& neighbours) {
  constexpr int kRounds = 3;
  constexpr int kSideRounds = 2;
  constexpr double kSharp = 0.05;  // where fewer points are, a bend of the surface alone is more uneven than 0.01
  const Eigen::Index size = points.rows();
  Scalars uneven(size);
  Points taken(size, 3);
  for (int round = 0; round < kRounds + kSideRounds; ++round) {
    parallel_for(size, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t i = begin; i < end; ++i) uneven[i] = disagreement(normals, neighbours, static_cast<Index>(i));
    });
    parallel_for(size, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t i = begin; i < end; ++i) {
        const auto point = static_cast<Index>(i);
        if (round >= kRounds && uneven[i] >= kSharp)
          taken.row(i) = best_side(points, normals, neighbours, point);
        else
          taken.row(i) = normals.row(round < kRounds ? most_even(points, normals, uneven, neighbours, point) : point);
      }
    });
    normals.swap(taken);
  }
  return normals;
}

}  // namespace batten
