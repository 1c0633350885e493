/// \file The points of a cloud that are nearest to a place.
#pragma once
#include <memory>

#include "batten/buffer.h"
#include "batten/types.h"

namespace batten {

/// A k-d tree of points, which it copies. Queries are safe from several threads.
class PointTree {
 public:
  explicit PointTree(Points points);
  ~PointTree();
  PointTree(PointTree&&) noexcept;
  PointTree& operator=(PointTree&&) noexcept;
  PointTree(const PointTree&) = delete;
  PointTree& operator=(const PointTree&) = delete;

  Index size() const;
  const Points& points() const;
  /// Finds the `count` points nearest to `place`, or all where there are fewer, nearest first; returns how many. Both
  /// arrays hold `count` entries; distances are squared. O(count log N).
  Index nearest(const Eigen::RowVector3d& place, Index count, Index* points, double* squares) const;
  /// The distance of the nearest point; infinite in an empty tree.
  double distance(const Eigen::RowVector3d& place) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

/// For each point of a tree its `count` nearest others: the numbers and the distances, N-by-count. Rows of a tree of
/// fewer points end in -1 and infinity.
struct NeighbourTable {
  Index count = 0;
  Buffer<Index> points;
  Buffer<double> distances;

  Index point(Index of, Index k) const { return points[static_cast<std::size_t>(of) * count + k]; }
  double distance(Index of, Index k) const { return distances[static_cast<std::size_t>(of) * count + k]; }
};

/// O(N count log N), threaded.
NeighbourTable find_neighbours(const PointTree& tree, Index count, const Progress& progress = {});

}  // namespace batten
