#include "batten/fit/point_tree.h"

#include <cmath>
#include <limits>
#include <nanoflann.hpp>
#include <vector>

#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// What nanoflann asks of points.
struct TreePoints {
  Points points;
  std::size_t kdtree_get_point_count() const { return static_cast<std::size_t>(points.rows()); }
  double kdtree_get_pt(std::size_t row, std::size_t axis) const {
    return points(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(axis));
  }
  template <typename Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }
};

using KdTree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, TreePoints>, TreePoints, 3, Index>;

}  // namespace

struct PointTree::Tree {
  explicit Tree(Points points)
      : cloud{std::move(points)}, search(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(kLeaf)) {}
  static constexpr std::size_t kLeaf = 12;
  TreePoints cloud;
  KdTree search;
};

PointTree::PointTree(Points points) : tree_(std::make_unique<Tree>(std::move(points))) {}
PointTree::~PointTree() = default;
PointTree::PointTree(PointTree&&) noexcept = default;
PointTree& PointTree::operator=(PointTree&&) noexcept = default;

Index PointTree::size() const { return static_cast<Index>(tree_->cloud.points.rows()); }

const Points& PointTree::points() const { return tree_->cloud.points; }

Index PointTree::nearest(const Eigen::RowVector3d& place, Index count, Index* points, double* squares) const {
  if (size() == 0 || count == 0) return 0;
  return static_cast<Index>(tree_->search.knnSearch(place.data(), static_cast<std::size_t>(count), points, squares));
}

double PointTree::distance(const Eigen::RowVector3d& place) const {
  Index point = 0;
  double square = 0.0;
  return nearest(place, 1, &point, &square) == 0 ? std::numeric_limits<double>::infinity() : std::sqrt(square);
}

NeighbourTable find_neighbours(const PointTree& tree, Index count, const Progress& progress) {
  const Index size = tree.size();
  NeighbourTable table;
  table.count = count;
  table.points.resize(static_cast<std::size_t>(size) * count);
  table.distances.resize(static_cast<std::size_t>(size) * count);
  const auto find = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    std::vector<Index> points(static_cast<std::size_t>(count) + 1);
    std::vector<double> squares(static_cast<std::size_t>(count) + 1);
    for (std::ptrdiff_t row = begin; row < end; ++row) {
      const Index found = tree.nearest(tree.points().row(row), count + 1, points.data(), squares.data());
      Index filled = 0;
      for (Index k = 0; k < found && filled < count; ++k) {
        if (points[k] == row) continue;
        table.points[row * count + filled] = points[k];
        table.distances[row * count + filled++] = std::sqrt(squares[k]);
      }
      for (; filled < count; ++filled) {
        table.points[row * count + filled] = -1;
        table.distances[row * count + filled] = std::numeric_limits<double>::infinity();
      }
    }
  };
  parallel_for(size, find, 512, progress);
  return table;
}

}  // namespace batten
