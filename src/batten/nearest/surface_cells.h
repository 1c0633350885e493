/// \file The limit surface as cells in a tree of boxes: nets of polynomials, and around irregular vertices rings that
/// halve on demand.
///
/// A cell's net follows from the control points of its piece (patch/pieces.h) by a matrix that all pieces alike share,
/// so a cell takes 8 bytes and its box 28.
#pragma once
#include <memory>
#include <vector>

#include "batten/nearest/bezier_net.h"
#include "batten/nearest/box_tree.h"
#include "batten/patch/pieces.h"
#include "batten/patch/ring_steps.h"

namespace batten {

/// A part of a piece: a net, or the one-ring of a part that is irregular.
struct CellShape {
  Placement placement;  ///< in the piece
  Index kind;           ///< of RingSteps; kPatch for a net
  Index rows;           ///< points of the net or of the ring
  Index columns;        ///< control points of the piece
  Buffer<double> weights;
};

/// How pieces fall into cells.
template <typename Net>
class CellShapes {
 public:
  static constexpr int kMostHalvings = 3;

  CellShapes(const Pieces& pieces, RingSteps& steps);

  struct Range {
    Index first;
    Index count;
  };
  /// A regular piece halved so often.
  Range regular(int halvings) const { return regular_[halvings]; }
  Range irregular(std::int32_t configuration) const { return irregular_[configuration]; }
  const CellShape& shape(Index i) const { return shapes_[i]; }
  /// Of a cell, or control points of a piece.
  Index most_points() const { return most_points_; }

 private:
  struct Matrix {
    Index rows;
    Index columns;
    Buffer<double> weights;
  };
  void add_regular(const Matrix& net, const Placement& placement, int halvings);
  void add_ring(const RingSteps& steps, Index kind, const Matrix& ring, const Placement& placement, int levels);
  void add_shape(const Placement& placement, Index kind, const Matrix& matrix);

  std::vector<CellShape> shapes_;
  std::array<Range, kMostHalvings + 1> regular_{};
  std::vector<Range> irregular_;
  Index most_points_ = Net::kPoints;
};

/// Points of a patch's rows, in the order of its spline, become its net.
template <typename Net>
void net_of_spline(const Double4* spline, Double4* net);

/// The points of a ring's child, `child.rows` of the ring, completed where it is a patch.
template <typename Net>
void ring_child_points(const RingSteps::Child& child, const Double4* ring, Double4* points);

/// The cells of a surface, and what a search needs of it. Const once built.
template <typename Net>
class SurfaceCells {
 public:
  /// control: V-by-3, finite. Faces of holes have no cells. Throws what Pieces throws.
  SurfaceCells(const Topology& topology, const Scheme& scheme, ConstValuesRef control, const Progress& progress);

  const Topology& base() const { return pieces_->topology(0); }
  const RingSteps& steps() const { return steps_; }
  const BoxTree& tree() const { return tree_; }
  /// The tree has (point - centre) * scale of a point, which is about 1: squares of floats must not leave their range.
  const Double4& centre() const { return centre_; }
  double scale() const { return scale_; }

  /// A cell of the tree.
  struct Cell {
    Index piece;
    Index shape;
  };
  const CellShape& shape(const Cell& cell) const { return shapes_->shape(cell.shape); }
  Index cell_count() const { return static_cast<Index>(cells_.size()); }
  const Cell& cell(Index place) const { return cells_[place]; }
  Index face(const Cell& cell) const { return pieces_->begin(0)[cell.piece].face; }
  Placement placement(const Cell& cell) const;  ///< in its face
  /// The cell's net or ring as seen from a point. `scratch` has room for the control points of any piece.
  void points(const Cell& cell, const Double4& origin, Double4* scratch, Double4* points) const;
  std::size_t most_points() const { return most_points_; }
  /// Of the base's vertex.
  const Double4& limit_position(Index vertex) const { return limits_[vertex]; }

 private:
  void gather(const Piece& piece, const Double4& origin, Double4* points) const;
  int halvings(const Piece& piece, Double4* scratch) const;
  void find_values(ConstValuesRef base_values);
  void choose_cells(const Buffer<std::uint8_t>& holes, const Progress& progress);
  void build_tree(const Progress& progress);
  void gather_bounds(const Cell& cell, std::vector<Double4>& scratch, std::vector<Double4>& bounds) const;
  void add_ring_bounds(Index kind, std::vector<Double4>& ring, int levels, std::vector<Double4>& bounds) const;
  Buffer<std::uint8_t> base_holes(const Topology& topology, const Scheme& scheme) const;

  std::unique_ptr<Refinement> first_;
  std::unique_ptr<Pieces> pieces_;
  RingSteps steps_;
  std::unique_ptr<CellShapes<Net>> shapes_;
  std::vector<Buffer<Double4>> values_;  ///< of each level
  Buffer<Double4> limits_;
  Buffer<Cell> cells_;
  BoxTree tree_;
  Double4 centre_{};
  double scale_ = 1.0;
  std::size_t most_points_ = 0;
};

}  // namespace batten
