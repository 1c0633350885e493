/// \file From the ring of an irregular face down to a child, or straight to one that is several halvings away.
#pragma once
#include <array>
#include <vector>

#include "batten/patch/ring_types.h"
#include "batten/patch/spline_jet.h"

namespace batten {

/// A matrix of few numbers, four rows at a time: each column that one of them has stands once for all four.
struct RowsByFour {
  Buffer<Index> starts{0};  ///< a block of four rows each, and the end
  Buffer<Index> columns;
  Buffer<double> weights;  ///< four a column

  RowsByFour() = default;
  /// Of these rows of a matrix whose columns ascend; those missing from the last four are zero.
  RowsByFour(const SparseRows& matrix, const Buffer<Index>& rows);
  /// To as many rows as there are, rounded up to four.
  void apply(const Double4* from, Buffer<Double4>& to) const;
};

/// A ring or patch on the way down: its control points are points[rows[i]], seen from the origin.
struct Descent {
  Index type;
  const Double4* points;
  const Index* rows;
  Double4 origin;
};

/// What a descent may use, one object for each thread.
struct DescentScratch {
  Buffer<Double4> ring;
  Buffer<Double4> centred;
  Buffer<Index> order;  ///< 0, 1, 2, ...: the rows of a ring that stands in a row
  FaceRing gathered;    ///< a large ring
};

/// The matrices of RingTypes and, where a corner's child is a ring of the same type, of several halvings at once.
class RingDescents {
 public:
  /// The types must outlive it. O(size of their matrices).
  explicit RingDescents(const RingTypes& types);

  /// So many halvings towards a corner can be had with the one that follows.
  int most_to_corner(Index type, int corner) const { return static_cast<int>(deeper_[type][corner].size()); }
  /// Halvings towards a corner, no more than that, then one to a child.
  void descend(int corner, int halvings, int child, DescentScratch& scratch, Descent& at) const;

 private:
  using Children = std::array<RowsByFour, 4>;
  const RingTypes& types_;
  std::vector<Children> children_;                            ///< of each type
  std::vector<std::array<std::vector<Children>, 4>> deeper_;  ///< of each type and corner: after one halving, two, ...
};

}  // namespace batten
