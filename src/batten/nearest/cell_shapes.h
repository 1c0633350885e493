/// \file How the pieces of a surface fall into cells: nets of polynomials, and around irregular vertices rings that the
/// search halves.
#pragma once
#include <vector>

#include "batten/nearest/bezier_net.h"
#include "batten/patch/pieces.h"
#include "batten/patch/ring_types.h"
#include "batten/patch/surface_patches.h"

namespace batten {

/// A part of a piece: a net, or the one-ring of a part that is irregular.
struct CellShape {
  Placement placement;  ///< in the piece
  Index type;           ///< of RingTypes; kPatch for a net
  Index rows;           ///< points of the net or of the ring
  SparseRows weights;   ///< on the control points of the piece; without rows for parts of regular pieces
};

/// The shapes of all cells, and which of them a piece consists of. Memory is linear in the sizes of the rings.
template <typename Net>
class CellShapes {
 public:
  static constexpr int kMostHalvings = 3;

  explicit CellShapes(const SurfacePatches& patches);

  struct Range {
    Index first;
    Index count;
  };
  /// The shapes of a regular piece that is halved so many times.
  Range regular(int halvings) const { return regular_[halvings]; }
  Range irregular(std::int32_t shared_ring) const { return irregular_[shared_ring]; }
  const CellShape& shape(Index i) const { return shapes_[i]; }
  /// The points of a shape's net or ring, from the control points of the piece.
  void points(Index shape, const Double4* control, Double4* points) const;
  /// The most points that a piece or a cell has.
  Index most_points() const { return most_points_; }

 private:
  /// Points as combinations of the `columns` control points of a piece.
  struct Matrix {
    SparseRows rows;
    Index columns;
  };
  void add_regular(const SplineMatrix<Net>& matrix, const Placement& placement, int halvings);
  void add_ring(const RingTypes& steps, Index type, const Matrix& ring, const Placement& placement, int levels);
  void add_shape(const Placement& placement, Index type, const Matrix& matrix);

  std::vector<CellShape> shapes_;
  std::vector<SplineMatrix<Net>> regular_matrices_;  ///< of the first shapes: those of regular pieces
  std::array<Range, kMostHalvings + 1> regular_{};
  std::vector<Range> irregular_;
  Index most_points_ = Net::kPoints;
};

/// Finds the control points of a patch that are missing, by reflection.
template <typename Net>
void complete_patch(const Index* rows, Double4* points) {
  complete_patch(Net::kCorners == 4, rows, reinterpret_cast<double*>(points), 4);
}

/// to[r] for each row, with `combine` inlined: a query comes here for every ring that it halves.
void combine_rows(const SparseRows& rows, const Double4* from, Double4* to);

/// The points of a ring's child: `child.rows` of the ring, completed where it is a patch.
template <typename Net>
void ring_child_points(const RingTypes::Child& child, const Double4* ring, Double4* points);

}  // namespace batten
