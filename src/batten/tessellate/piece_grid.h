/// \file The points of one face's grid, filled piece by piece in the cache.
#pragma once
#include <span>
#include <vector>

#include "batten/patch/level_values.h"
#include "batten/tessellate/piece_tables.h"

namespace batten {

/// A face's points in planes of their own, one a column: (i, j) at (steps + 1) j + i.
template <typename Scalar>
struct PieceGrid {
  Index steps;
  int columns;
  Buffer<Scalar> planes;

  PieceGrid(Index steps_in, int columns_in)
      : steps(steps_in), columns(columns_in), planes(static_cast<std::size_t>(columns * plane_size())) {}
  std::ptrdiff_t width() const { return std::ptrdiff_t{steps} + 1; }
  std::ptrdiff_t plane_size() const { return padded(width() * width()); }
  std::ptrdiff_t place(Index i, Index j) const { return width() * j + i; }
  Scalar* plane(int column) { return planes.data() + column * plane_size(); }
  const Scalar* plane(int column) const { return planes.data() + column * plane_size(); }
};

/// Fills grids with one or more kinds of value of the same surface; one object for each thread at work.
template <typename Scalar>
class GridFiller {
 public:
  using Tables = PieceTables<Scalar>;

  /// Tangents stand after positions in `tables`, which must outlive it.
  GridFiller(const Pieces& pieces, std::span<const Tables* const> tables, const LevelValues& values);
  /// grids[i] by tables[i], all of the same columns.
  void fill(Index face, std::span<PieceGrid<Scalar>> grids);

 private:
  void gather(const Piece& piece, int count, int columns);
  void turn_to_tangents(const Piece& piece, int count, int columns);
  void fill_patch(const Piece& piece, const Tables& tables, PieceGrid<Scalar>& grid);
  void fill_quad_patch(const Piece& piece, const typename Tables::Patch& patch, PieceGrid<Scalar>& grid);
  void fill_points(const Piece& piece, const Scalar* weights, std::ptrdiff_t stride, int count,
                   PieceGrid<Scalar>& grid);
  void fill_cell(const Piece& piece, TileValue value, PieceGrid<Scalar>& grid);

  const Pieces& pieces_;
  std::span<const Tables* const> tables_;
  const LevelValues& values_;
  bool quads_;
  Buffer<Scalar> control_;  ///< rows of k numbers, from the origin
  Buffer<Scalar> origin_;   ///< k numbers to add to sums; zeros for tangents
  Buffer<Scalar> scratch_;
  FaceRing scratch_ring_;
  /// The limit position that was summed last: many cells in a row share a vertex of high valence.
  int last_level_ = -1;
  Index last_vertex_ = -1;
  Eigen::RowVectorXd last_limit_;
};

}  // namespace batten
