/// \file The points of one face's grid, filled piece by piece in the cache.
#pragma once
#include <vector>

#include "batten/limit/piece_tables.h"

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

/// Control values for the pieces of all levels.
class LevelValues {
 public:
  LevelValues(const Pieces& pieces, ConstValuesRef base);
  ConstValuesRef at(int level) const { return level == 0 ? base_ : refined_[level - 1]; }

 private:
  Eigen::Ref<const Values, 0, Eigen::OuterStride<>> base_;
  std::vector<Eigen::Ref<const Values, 0, Eigen::OuterStride<>>> refined_;
  std::vector<Values> storage_;
};

/// Fills grids with one kind of value; one object for each thread at work.
template <typename Scalar>
class GridFiller {
 public:
  GridFiller(const Pieces& pieces, const PieceTables<Scalar>& tables, const LevelValues& values);
  void fill(Index face, PieceGrid<Scalar>& grid);

 private:
  void gather(const Piece& piece, int count, int columns);
  void fill_quad_patch(const Piece& piece, PieceGrid<Scalar>& grid);
  void fill_points(const Piece& piece, const Scalar* weights, std::ptrdiff_t stride, int count,
                   PieceGrid<Scalar>& grid);
  void fill_cell(const Piece& piece, PieceGrid<Scalar>& grid);

  const Pieces& pieces_;
  const PieceTables<Scalar>& tables_;
  const LevelValues& values_;
  bool quads_;
  Buffer<Scalar> control_;  ///< rows of k numbers, from the origin
  Buffer<Scalar> origin_;   ///< k numbers; then k to add to sums: the same, or zeros
  Buffer<Scalar> scratch_;
};

}  // namespace batten
