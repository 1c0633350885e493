#include "batten/adaptive/cell_forest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "batten/error.h"
#include "batten/patch/corner_parameters.h"

namespace batten {

CellForest::CellForest(const Topology& base, Buffer<std::uint8_t> left_out)
    : base_(base), corners_(base.uniform_face_size()), left_out_(std::move(left_out)) {
  if (base.face_count() > 0 && corners_ != 3 && corners_ != 4) {
    throw Error(ErrorCode::NotTriangles, "a forest of cells has a base of quads or of triangles");
  }
  if (!left_out_.empty() && left_out_.size() != static_cast<std::size_t>(base.face_count())) {
    throw Error(ErrorCode::BadShape, "one flag a face says what is left out");
  }
  Buffer<Index> number(static_cast<std::size_t>(base.vertex_count()), -1);
  for (Index f = 0; f < base.face_count(); ++f) {
    for (Index h = base.face_begin(f); !is_left_out(f) && h < base.face_end(f); ++h) number[base.origin(h)] = 0;
  }
  Index used = 0;
  for (Index& n : number) n = n < 0 ? -1 : used++;
  vertices_.resize(static_cast<std::size_t>(used), {-1, 0.0, 0.0});
  cells_.resize(static_cast<std::size_t>(base.face_count()));
  for (Index f = 0; f < base.face_count(); ++f) {
    Cell& cell = cells_[f];
    cell = {f, -1, -1, {-1, -1, -1, -1}, 0.0F, 0.0F, 0, 0, false};
    for (int k = 0; k < corners_; ++k) {
      cell.corners[k] = number[base.origin(base.face_begin(f) + k)];
      if (is_left_out(f) || vertices_[cell.corners[k]].face >= 0) continue;
      const std::array<double, 2> at = corner_parameters(corners_, k);
      vertices_[cell.corners[k]] = {f, at[0], at[1]};
    }
  }
}

Buffer<Index> CellForest::leaves() const {
  Buffer<Index> found;
  for (Index c = 0; c < cell_count(); ++c) {
    if (is_leaf(c) && !is_left_out(cells_[c].face)) found.push_back(c);
  }
  return found;
}

int CellForest::deepest_level() const {
  int deepest = 0;
  for (const Cell& cell : cells_) deepest = std::max<int>(deepest, cell.level);
  return deepest;
}

/// The side of a sibling across a side, or cell -1 if the side is on the parent's side.
CellForest::Side CellForest::sibling(Index first, int number, int side) const {
  if (corners_ == 4) {
    if (side == ((number + 1) & 3)) return {first + ((number + 1) & 3), (number + 3) & 3};
    if (side == ((number + 2) & 3)) return {first + ((number + 3) & 3), number};
    return {-1, 0};
  }
  if (number == 3) return {first + (side + 2) % 3, side};
  return side == (number + 1) % 3 ? Side{first + 3, side} : Side{-1, 0};
}

CellForest::Side CellForest::neighbour(Index cell, int side) const {
  const Cell& here = cells_[cell];
  if (here.parent < 0) {
    const Index twin = base_.twin(base_.face_begin(cell) + side);
    if (twin < 0 || is_left_out(base_.face(twin))) return {-1, 0};
    const Index face = base_.face(twin);
    return {face, static_cast<int>(twin - base_.face_begin(face))};
  }
  const Side inner = sibling(cells_[here.parent].first_child, here.number, side);
  if (inner.cell >= 0) return inner;
  // The first half of the parent's side is across from the second half of the neighbour's, and vice versa.
  const Side across = neighbour(here.parent, side);
  if (across.cell < 0 || is_leaf(across.cell)) return across;
  return {child(across.cell, side == here.number ? next(across.side) : across.side), across.side};
}

Index CellForest::hanging_vertex(Index cell, int side) const {
  const Side across = neighbour(cell, side);
  if (across.cell < 0 || is_leaf(across.cell)) return -1;
  return corner(child(across.cell, across.side), next(across.side));
}

SurfacePlace CellForest::place(Index cell, double u, double v) const {
  const Cell& here = cells_[cell];
  const double size = std::ldexp(here.turned ? -1.0 : 1.0, -here.level);
  return {here.face, here.u + size * u, here.v + size * v};
}

/// Splits neighbours until each is at least as fine as the cell.
void CellForest::level_neighbours(Index cell) {
  for (int s = 0; s < corners_; ++s) {
    const Side across = neighbour(cell, s);
    if (across.cell >= 0 && cells_[across.cell].level < cells_[cell].level) split(across.cell);
  }
}

/// The neighbour's vertex, if it has one already.
Index CellForest::middle_vertex(Index cell, int side) {
  const Index shared = hanging_vertex(cell, side);
  if (shared >= 0) return shared;
  const std::array<double, 2> a = corner_parameters(corners_, side);
  const std::array<double, 2> b = corner_parameters(corners_, next(side));
  vertices_.push_back(place(cell, 0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])));
  return vertex_count() - 1;
}

void CellForest::split(Index cell) {
  if (!is_leaf(cell)) return;
  if (cells_[cell].level >= kMostLevels || cell_count() > std::numeric_limits<Index>::max() - 4) {
    throw Error(ErrorCode::TooLarge, "cells have at most " + std::to_string(kMostLevels) +
                                         " levels, and there are at most 2^31 - 1 of them; refine less");
  }
  level_neighbours(cell);
  std::array<Index, 4> middles{-1, -1, -1, -1};
  for (int s = 0; s < corners_; ++s) middles[s] = middle_vertex(cell, s);
  Index centre = -1;
  if (corners_ == 4) {
    vertices_.push_back(place(cell, 0.5, 0.5));
    centre = vertex_count() - 1;
  }
  add_children(cell, middles, centre);
}

void CellForest::add_children(Index cell, const std::array<Index, 4>& middles, Index centre) {
  const Cell parent = cells_[cell];
  cells_[cell].first_child = cell_count();
  for (int k = 0; k < 4; ++k) {
    const bool middle = k == corners_;
    const std::array<double, 2> at = middle ? std::array<double, 2>{1.0, 1.0} : corner_parameters(corners_, k);
    const SurfacePlace origin = place(cell, 0.5 * at[0], 0.5 * at[1]);
    Cell child{parent.face,
               cell,
               -1,
               {-1, -1, -1, -1},
               static_cast<float>(origin.u),
               static_cast<float>(origin.v),
               static_cast<std::uint8_t>(parent.level + 1),
               static_cast<std::uint8_t>(k),
               parent.turned != middle};
    for (int j = 0; j < corners_; ++j) {
      if (middle) {
        child.corners[j] = middles[next(j)];
      } else if (j == k) {
        child.corners[j] = parent.corners[k];
      } else if (j == next(k)) {
        child.corners[j] = middles[k];
      } else {
        child.corners[j] = next(j) == k ? middles[j] : centre;
      }
    }
    cells_.push_back(child);
  }
}

}  // namespace batten
