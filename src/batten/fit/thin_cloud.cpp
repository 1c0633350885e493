#include "batten/fit/thin_cloud.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace batten {

namespace {

/// A point in the box that it lies in.
struct BoxedPoint {
  std::array<std::int64_t, 3> box;
  double from_middle;
  Index row;
};

/// The point of each box, in the order of the boxes.
Buffer<Index> one_in_each_box(const Points& points, double side) {
  const Eigen::RowVector3d low = points.colwise().minCoeff();
  std::vector<BoxedPoint> boxed(static_cast<std::size_t>(points.rows()));
  for (Index i = 0; i < static_cast<Index>(points.rows()); ++i) {
    BoxedPoint& one = boxed[static_cast<std::size_t>(i)];
    one.row = i;
    one.from_middle = 0.0;
    for (int c = 0; c < 3; ++c) {
      const double place = (points(i, c) - low[c]) / side;
      const double box = std::floor(place);
      one.box[static_cast<std::size_t>(c)] = static_cast<std::int64_t>(box);
      one.from_middle += (place - box - 0.5) * (place - box - 0.5);
    }
  }
  std::sort(boxed.begin(), boxed.end(), [&](const BoxedPoint& a, const BoxedPoint& b) {
    if (a.box != b.box) return a.box < b.box;
    if (a.from_middle != b.from_middle) return a.from_middle < b.from_middle;
    for (int c = 0; c < 3; ++c) {
      if (points(a.row, c) != points(b.row, c)) return points(a.row, c) < points(b.row, c);
    }
    return a.row < b.row;
  });
  Buffer<Index> rows;
  for (std::size_t i = 0; i < boxed.size(); ++i) {
    if (i == 0 || boxed[i].box != boxed[i - 1].box) rows.push_back(boxed[i].row);
  }
  return rows;
}

}  // namespace

Buffer<Index> thinned_rows(const Points& points, Index most) {
  constexpr int kTrials = 4;
  constexpr double kEnough = 0.8;
  Buffer<Index> rows(static_cast<std::size_t>(points.rows()));
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<Index>(i);
  if (points.rows() <= most) return rows;
  // A surface through a box of side 1 has some area of 2; boxes of side h on it number about area / h^2.
  const double longest = (points.colwise().maxCoeff() - points.colwise().minCoeff()).maxCoeff();
  if (!(longest > 0.0)) return rows;
  double side = longest * std::sqrt(2.0 / most);
  for (int trial = 0; trial < kTrials; ++trial) {
    rows = one_in_each_box(points, side);
    const double share = static_cast<double>(rows.size()) / most;
    if (share <= 1.0 && share >= kEnough) break;
    side *= std::sqrt(share / 0.9);
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

}  // namespace batten
