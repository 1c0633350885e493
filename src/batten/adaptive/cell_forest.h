/// \file Faces cut into quarters where asked: a quadtree over each face of a base, neighbours never more than one level
/// apart (restricted, after von Herzen and Barr 1987, key HB87).
///
/// A cell is a quad or a triangle like its base, with its corners in the base's order; side s runs from corner s to
/// corner s + 1. Child k < N of a cell lies at its corner k, in a frame parallel to it; a triangle's fourth child is
/// the middle, turned by half, with corner k opposite corner k. No points and no masks in here: vertices are numbers
/// with places.
#pragma once
#include <array>

#include "batten/mesh/topology.h"
#include "batten/patch/surface_place.h"

namespace batten {

/// Cells come to a forest by split() only and stay. Memory: 40 bytes a cell, 24 a vertex. The base must outlive it.
class CellForest {
 public:
  struct Side {
    Index cell;  ///< -1: none, a boundary
    int side;
  };
  /// Exact (u, v), and 16 levels, in floats.
  static constexpr int kMostLevels = 16;

  /// One cell a face, numbered as the face. base: quads or triangles only. left_out: F flags, or empty; faces that are
  /// no cells, whose sides are boundaries. Throws Error(NotTriangles, BadShape).
  explicit CellForest(const Topology& base, Buffer<std::uint8_t> left_out = {});

  const Topology& base() const { return base_; }
  int corner_count() const { return corners_; }
  bool is_left_out(Index face) const { return !left_out_.empty() && left_out_[face] != 0; }

  /// Cuts a leaf into four, and before it those neighbours that would be two levels coarser. Amortised O(1).
  /// Throws Error(TooLarge) beyond kMostLevels, or 2^31 - 1 cells.
  void split(Index cell);

  Index cell_count() const { return static_cast<Index>(cells_.size()); }  ///< leaves and others, and faces left out
  bool is_leaf(Index cell) const { return cells_[cell].first_child < 0; }
  Index child(Index cell, int number) const { return cells_[cell].first_child + number; }
  int level(Index cell) const { return cells_[cell].level; }
  Index face(Index cell) const { return cells_[cell].face; }  ///< of the base
  Index corner(Index cell, int number) const { return cells_[cell].corners[number]; }
  /// Cells without what is left out, in their order.
  Buffer<Index> leaves() const;
  int deepest_level() const;

  /// What lies across a side: a cell of the same level (perhaps cut itself), or else a leaf one level coarser.
  /// O(1) on average, O(level) at most.
  Side neighbour(Index cell, int side) const;
  /// The vertex in the middle of a leaf's side where the neighbour is finer, otherwise -1.
  Index hanging_vertex(Index cell, int side) const;

  /// From a cell's own parameters to its base face's. Corners have (u, v) of the form k / 2^level, exact.
  SurfacePlace place(Index cell, double u, double v) const;
  /// Vertices: the base's that a cell uses, in their order, then others as they came.
  Index vertex_count() const { return static_cast<Index>(vertices_.size()); }
  const Buffer<SurfacePlace>& vertex_places() const { return vertices_; }

 private:
  struct Cell {
    Index face;
    Index parent;       // -1: a root
    Index first_child;  // -1: a leaf; four in a row
    std::array<Index, 4> corners;
    float u;  // corner 0, in the base face
    float v;
    std::uint8_t level;
    std::uint8_t number;  // which child
    bool turned;
  };
  int next(int side) const { return side + 1 == corners_ ? 0 : side + 1; }
  Side sibling(Index first, int number, int side) const;
  void level_neighbours(Index cell);
  void add_children(Index cell, const std::array<Index, 4>& middles, Index centre);
  Index middle_vertex(Index cell, int side);

  Topology base_;
  int corners_;
  Buffer<std::uint8_t> left_out_;
  Buffer<Cell> cells_;
  Buffer<SurfacePlace> vertices_;
};

/// A cell's corners in its own parameters.
inline std::array<double, 2> cell_corner(int corner_count, int number) {
  if (corner_count == 3) return {number == 1 ? 1.0 : 0.0, number == 2 ? 1.0 : 0.0};
  return {number == 1 || number == 2 ? 1.0 : 0.0, number >= 2 ? 1.0 : 0.0};
}

}  // namespace batten
