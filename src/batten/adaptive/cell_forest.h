/// \file A quadtree over each face of a base whose cells are split on request, with neighbours at most one level apart
/// (restricted, after von Herzen and Barr 1987, key HB87).
///
/// A cell is a quad or a triangle like its base, with its corners in the same order; side s runs from corner s to
/// corner s + 1. Child k < N of a cell is at its corner k, in a frame parallel to the cell's. The fourth child of a
/// triangle is the middle one, turned by half a turn, with corner k opposite corner k. The forest has no points:
/// vertices are numbers with places.
#pragma once
#include <array>

#include "batten/mesh/topology.h"
#include "batten/patch/surface_place.h"

namespace batten {

/// split() adds cells; cells are never removed. Memory: 40 bytes for each cell, 24 for each vertex. The base must
/// outlive it.
class CellForest {
 public:
  struct Side {
    Index cell;  ///< -1 at a boundary
    int side;
  };
  /// Floats hold (u, v) exactly at up to 16 levels.
  static constexpr int kMostLevels = 16;

  /// One cell for each face, with the face's number. base: quads or triangles only. left_out: F flags, or empty;
  /// flagged faces are no cells, and their sides are boundaries. Throws Error(NotTriangles, BadShape).
  explicit CellForest(const Topology& base, Buffer<std::uint8_t> left_out = {});

  const Topology& base() const { return base_; }
  int corner_count() const { return corners_; }
  bool is_left_out(Index face) const { return !left_out_.empty() && left_out_[face] != 0; }

  /// Splits a leaf into four, after splitting those neighbours that would be two levels coarser. Amortised O(1). Throws
  /// Error(TooLarge) beyond kMostLevels, or 2^31 - 1 cells.
  void split(Index cell);

  /// Including cells that are not leaves and faces that are left out.
  Index cell_count() const { return static_cast<Index>(cells_.size()); }
  bool is_leaf(Index cell) const { return cells_[cell].first_child < 0; }
  Index child(Index cell, int number) const { return cells_[cell].first_child + number; }
  int level(Index cell) const { return cells_[cell].level; }
  Index face(Index cell) const { return cells_[cell].face; }  ///< the base face of a cell
  Index corner(Index cell, int number) const { return cells_[cell].corners[number]; }
  /// The leaves in order, without faces that are left out.
  Buffer<Index> leaves() const;
  int deepest_level() const;

  /// The cell across a side: one of the same level (which may be split), or else a leaf one level coarser. O(1) on
  /// average, O(level) at most.
  Side neighbour(Index cell, int side) const;
  /// The vertex in the middle of a leaf's side if the neighbour is finer, otherwise -1.
  Index hanging_vertex(Index cell, int side) const;

  /// Converts a cell's own parameters to its base face's. Corners have (u, v) of the form k / 2^level, exactly.
  SurfacePlace place(Index cell, double u, double v) const;
  /// The vertices are those of the base that a cell uses, in order, followed by others in the order of their creation.
  Index vertex_count() const { return static_cast<Index>(vertices_.size()); }
  const Buffer<SurfacePlace>& vertex_places() const { return vertices_; }

 private:
  struct Cell {
    Index face;
    Index parent;       // -1 for a root
    Index first_child;  // -1 for a leaf; the four are consecutive
    std::array<Index, 4> corners;
    float u;  // of corner 0, in the base face
    float v;
    std::uint8_t level;
    std::uint8_t number;  // which child of its parent
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

}  // namespace batten
