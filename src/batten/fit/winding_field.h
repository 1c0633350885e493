/// \file How often a cloud of points with normals winds around a place: near 1 inside, near 0 outside.
///
/// Each point stands for a small piece of the surface, and the solid angles of the pieces are added (Barill and others
/// 2018, key BDSLJ18): w(q) = sum_i a_i n_i . (p_i - q) / (4 pi (|p_i - q|^2 + e_i^2)^(3/2)). Holes are closed
/// smoothly. Unlike there, e_i, a share of the spacing, keeps the field bounded near a point.
#pragma once
#include "batten/buffer.h"
#include "batten/types.h"

namespace batten {

/// A tree of the sum. Safe to use from several threads.
class WindingField {
 public:
  /// points, normals: N-by-3; areas, widths (e): N. O(N log N).
  WindingField(const Points& points, const Points& normals, const Scalars& areas, const Scalars& widths);

  /// About 1 % exact: pieces that are together seen from 2.5 of their radii away count as one. O(log N).
  double value(const Eigen::RowVector3d& place) const;
  /// The direction in which it falls fastest, by the same rule: outwards on the surface.
  Eigen::RowVector3d fall(const Eigen::RowVector3d& place) const;

 private:
  struct Piece {
    double at[3];
    double area[3];  ///< times the normal
    double width_square;
  };
  struct Node {
    Piece sum;
    double reach_square;  ///< nearer than this the children are asked
    Index begin;
    Index end;
    Index skip;  ///< the next node where this one is done with
  };
  static double part(const Piece& piece, const Eigen::RowVector3d& place);
  static Eigen::RowVector3d fall_part(const Piece& piece, const Eigen::RowVector3d& place);
  /// Adds what `part` says of pieces and nodes.
  template <typename Sum, typename Part>
  void add(const Eigen::RowVector3d& place, Sum& sum, const Part& part) const;
  Index build(Index begin, Index end, const Points& points);
  Node summed(Index begin, Index end) const;

  Buffer<Piece> pieces_;
  Buffer<Index> order_;
  Buffer<Node> nodes_;
};

}  // namespace batten
