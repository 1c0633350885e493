#include "batten/fit/outliers.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "batten/fit/belonging.h"
#include "batten/fit/cloud_samples.h"
#include "batten/fit/orientation.h"
#include "batten/fit/thin_cloud.h"
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

/// Those of the points that are nearer than `reach` to one of the centres, ascending.
std::vector<Index> rows_near(const Points& points, const PointTree& centres, double reach) {
  Buffer<std::uint8_t> near(static_cast<std::size_t>(points.rows()), 0);
  parallel_for(points.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) near[i] = centres.distance(points.row(i)) < reach ? 1 : 0;
  });
  std::vector<Index> rows;
  for (Index i = 0; i < static_cast<Index>(near.size()); ++i) {
    if (near[i] != 0) rows.push_back(i);
  }
  return rows;
}

/// One point of each place.
Points different_points(const Points& points) {
  Points different(points.rows(), 3);
  Index count = 0;
  for (const Index row : sorted_rows(points)) {
    if (count == 0 || different.row(count - 1) != points.row(row)) different.row(count++) = points.row(row);
  }
  different.conservativeResize(count, 3);
  return different;
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

double sampled_spacing(const Points& points, double reach) {
  constexpr Index kFew = 20000;
  constexpr Index kSamples = 200;
  const bool all = points.rows() <= kFew;
  const PointTree centres(all ? points : Points(points(thinned_rows(points, kSamples), Eigen::all)));
  const Points near = different_points(all ? points : Points(points(rows_near(points, centres, reach), Eigen::all)));
  const NeighbourTable found = find_neighbours(PointTree(near), 1);
  Buffer<double> nearest;
  for (Index i = 0; i < static_cast<Index>(near.rows()); ++i) {
    // All that is as near as half the reach to it is near the centre, too.
    if (found.point(i, 0) >= 0 && (all || centres.distance(near.row(i)) < 0.5 * reach))
      nearest.push_back(found.distance(i, 0));
  }
  return nearest.empty() ? reach : quantile(nearest, 0.5);
}

OutlierFilter::OutlierFilter(const Points& points, const Progress& progress)
    : tree_(points),
      neighbours_(find_neighbours(tree_, kCloudNeighbours, progress)),
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

bool OutlierFilter::has_lonely() const { return std::count(lonely_.begin(), lonely_.end(), std::uint8_t{1}) > 0; }

Buffer<std::uint8_t> OutlierFilter::lonely_and_far(const Scalars& distances) const {
  Buffer<std::uint8_t> flags = lonely_;
  for (std::size_t i = 0; i < flags.size(); ++i) {
    if (!(distances[static_cast<Eigen::Index>(i)] > kFarInSpacings * spacing_)) flags[i] = 0;
  }
  return flags;
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

Scalars OutlierFilter::belonging_to(const Buffer<std::uint8_t>& far, const Points& offsets) const {
  return belonging({tree_.points(), neighbours_, far, spacing_}, offsets);
}

Buffer<std::uint8_t> OutlierFilter::far_of(const Points& all, const Scalars& distances, const Scalars& own,
                                           double spacing) const {
  // 1: far beside this filter's points; 2: beside a lonely one.
  Buffer<std::uint8_t> flags(static_cast<std::size_t>(all.rows()), 0);
  parallel_for(all.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    Index found[kCloudNeighbours];
    double squares[kCloudNeighbours];
    std::vector<double> around;
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      if (!(distances[i] > kFarInSpacings * spacing)) continue;
      const Index count = tree_.nearest(all.row(i), kCloudNeighbours, found, squares);
      around.clear();
      for (Index k = 0; k < count; ++k) {
        if (lonely_[found[k]] == 0) around.push_back(own[found[k]]);
      }
      if (around.empty() || distances[i] > kFar * quantile(around, 0.5)) flags[i] = 1;
      if (count > 0 && lonely_[found[0]] != 0) flags[i] = 2;
    }
  });
  leave_far_parts(all, distances, flags);
  return flags;
}

/// What this filter's points are too far apart to tell: whether the points beside it are as far.
void OutlierFilter::leave_far_parts(const Points& all, const Scalars& distances, Buffer<std::uint8_t>& flags) const {
  std::vector<Index> far;
  for (Index i = 0; i < static_cast<Index>(flags.size()); ++i) {
    if (flags[i] == 1) far.push_back(i);
    if (flags[i] == 2) flags[i] = 1;
  }
  if (far.empty()) return;
  const std::vector<Index> rows = rows_near(all, PointTree(all(far, Eigen::all)), spacing_);
  const PointTree tree(all(rows, Eigen::all));
  parallel_for(static_cast<std::ptrdiff_t>(far.size()), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    Index found[kCloudNeighbours + 1];
    double squares[kCloudNeighbours + 1];
    std::vector<double> around;
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      const Index count = tree.nearest(all.row(far[i]), kCloudNeighbours + 1, found, squares);
      around.clear();
      for (Index k = 0; k < count && squares[k] < spacing_ * spacing_; ++k) {
        if (rows[found[k]] != far[i]) around.push_back(distances[rows[found[k]]]);
      }
      const bool is_part = static_cast<Index>(around.size()) >= kCloudNeighbours / 2;
      if (is_part && distances[far[i]] <= kFar * quantile(around, 0.5)) flags[far[i]] = 0;
    }
  });
}

}  // namespace batten
