#include "batten/fit/sharp_normals.h"

#include <algorithm>

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

}  // namespace

Points sharp_normals(const Points& points, Points normals, const NeighbourTable& neighbours) {
  constexpr int kRounds = 3;
  const Eigen::Index size = points.rows();
  Scalars uneven(size);
  Points taken(size, 3);
  for (int round = 0; round < kRounds; ++round) {
    parallel_for(size, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t i = begin; i < end; ++i) uneven[i] = disagreement(normals, neighbours, static_cast<Index>(i));
    });
    parallel_for(size, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t i = begin; i < end; ++i)
        taken.row(i) = normals.row(most_even(points, normals, uneven, neighbours, static_cast<Index>(i)));
    });
    normals.swap(taken);
  }
  return normals;
}

}  // namespace batten
