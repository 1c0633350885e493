/// \file The limit surface as cells in a tree of boxes: nets of polynomials, and around irregular vertices rings that
/// halve on demand.
///
/// A cell's net follows from the control points of its piece (patch/pieces.h) by a matrix that all pieces alike share,
/// so a cell takes 8 bytes and its box 64.
#pragma once
#include <span>
#include <vector>

#include "batten/limit/limit_matrix.h"
#include "batten/nearest/box_tree.h"
#include "batten/nearest/cell_shapes.h"

namespace batten {

/// The cells of a surface, and what a search needs of it. The pieces, the cells and their order in the tree belong to
/// the connectivity and the first control points; the boxes follow the present ones.
template <typename Net>
class SurfaceCells {
 public:
  /// control: V-by-3, finite. Faces of holes have no cells. Throws what Pieces throws, and Error(Cancelled).
  SurfaceCells(const SurfacePatches& patches, ConstValuesRef control, const Progress& progress);

  /// Moves the surface: V-by-3, finite. Throws Error(Cancelled), and then nothing has changed.
  void set_control(ConstValuesRef control, const Progress& progress);

  const Topology& base() const { return patches_.base(); }
  const RingTypes& ring_types() const { return patches_.ring_types(); }
  const BoxTree& tree() const { return tree_; }
  /// The tree has (point - centre) * scale of a point, which is about 1: squares of floats must not leave their range.
  const Double4& centre() const { return control_.centre; }
  double scale() const { return control_.scale; }

  /// A cell of the tree.
  struct Cell {
    Index piece;
    Index shape;
  };
  const CellShape& shape(const Cell& cell) const { return shapes_.shape(cell.shape); }
  Index cell_count() const { return static_cast<Index>(cells_.size()); }
  const Cell& cell(Index place) const { return cells_[place]; }
  Index face(const Cell& cell) const { return patches_.pieces().begin(0)[cell.piece].face; }
  Placement placement(const Cell& cell) const;  ///< in its face
  /// Memory of one thread.
  struct Scratch {
    explicit Scratch(std::size_t most_points) : control(most_points) {}

    std::vector<Double4> control;  ///< the control points of a piece
    FaceRing ring;
  };
  /// The cell's net or ring as seen from a point. `scratch` is made with most_points().
  void points(const Cell& cell, const Double4& origin, Scratch& scratch, Double4* points) const {
    gather(control_, patches_.pieces().begin(0)[cell.piece], origin, scratch);
    shapes_.points(cell.shape, scratch.control.data(), points);
  }
  /// The most points that a cell has, or control points that a piece has.
  std::size_t most_points() const { return static_cast<std::size_t>(shapes_.most_points()); }
  /// The most faces that a pole has (patch/poles.h).
  Index most_pole_faces() const { return patches_.pieces().poles().most_faces(); }
  /// The limit position of a vertex of the base.
  const Double4& limit_position(Index vertex) const { return control_.limits[vertex]; }

 private:
  /// What follows from the control points.
  struct Control {
    std::vector<Buffer<Double4>> levels;  ///< the control points of each level of the pieces
    Buffer<Double4> limits;
    Double4 centre{};
    double scale = 1.0;
  };
  /// For their boxes rings are halved so many times.
  static constexpr int kBoundLevels = 2;
  /// Points whose hull has a cell in it, and two directions along the cell; all in the tree's unit.
  struct Bounds {
    explicit Bounds(std::size_t most_points) : scratch(most_points), points(most_points) {}

    Scratch scratch;
    Index piece = -1;             ///< whose control points the scratch memory has
    std::vector<Double4> points;  ///< of the net or ring
    std::vector<Double4> of_ring;
    std::array<std::vector<Double4>, kBoundLevels> steps;  ///< of the children of a ring, of its ring children, ...
    std::vector<Double4> child;  ///< the ring or patch of one child, until its own children are worked out
    std::span<const Double4> hull;
    Double4 along{};
    Double4 across{};
  };

  Control control_of(ConstValuesRef control) const;
  Index gather(const Control& control, const Piece& piece, const Double4& origin, Scratch& scratch) const;
  int halvings(const Piece& piece, Scratch& scratch) const;
  void choose_cells(const Progress& progress);
  void sort_cells(const Progress& progress);
  void fit(const Control& control, BoxTree& tree, const Progress& progress) const;
  void find_bounds(const Control& control, const Cell& cell, Bounds& bounds) const;
  void add_ring_bounds(Index type, const Double4* ring, int levels, Bounds& bounds) const;

  SurfacePatches patches_;
  CellShapes<Net> shapes_;
  LimitMatrix limit_matrix_;
  Buffer<Cell> cells_;
  Control control_;
  BoxTree tree_;
  BoxTree spare_;  ///< empty, or the tree of the control points before, to be written over
};

}  // namespace batten
