/// \file Where the vertices of a tessellation stand (tessellate/tessellator.h has the order).
#pragma once
#include "batten/mesh/topology.h"
#include "batten/tessellate/piece_grid.h"

namespace batten {

/// A point of a face's grid: on half_edge, so many steps from its origin (0 <= from_origin < steps), or, with
/// half_edge -1, inside.
struct GridPoint {
  Index half_edge;
  Index from_origin;
};

/// Where the vertices of a refined base stand.
struct TessellationLayout {
  int levels;
  Index steps;
  bool quads;
  std::int64_t edge_start;  ///< of the points inside edges
  std::int64_t face_start;
  std::int64_t per_edge;
  std::int64_t per_face;
  std::int64_t vertices;
  std::int64_t faces_per_face;

  TessellationLayout(const Topology& base, bool quads_in, int levels_in)
      : levels(levels_in), steps(Index{1} << levels), quads(quads_in) {
    per_edge = steps - 1;
    per_face = quads ? per_edge * per_edge : per_edge * (per_edge - 1) / 2;
    edge_start = base.vertex_count();
    face_start = edge_start + per_edge * base.edge_count();
    vertices = face_start + per_face * base.face_count();
    faces_per_face = std::int64_t{steps} * steps;
  }
  std::int64_t inside_face(Index face, Index j) const {
    const std::int64_t rows = j - 1;
    return face_start + per_face * face + (quads ? rows * per_edge : rows * per_edge - rows * (rows + 1) / 2);
  }
  GridPoint locate(const Topology& base, Index face, Index i, Index j) const;
  /// The vertex at the point (i, j) of a face's grid. Deep grids have more vertices than an Index can count.
  std::int64_t number(const Topology& base, Index face, Index i, Index j) const;
  Index vertex(const Topology& base, Index face, Index i, Index j) const {
    return static_cast<Index>(number(base, face, i, j));
  }
  /// Number of grid points in row j.
  Index row_length(Index j) const { return quads ? steps + 1 : steps + 1 - j; }
};

inline GridPoint TessellationLayout::locate(const Topology& base, Index face, Index i, Index j) const {
  const Index first = base.face_begin(face);
  const Index n = steps;
  if (j == 0 && i < n) return {first, i};
  if (quads) {
    if (i == n && j < n) return {first + 1, j};
    if (j == n && i > 0) return {first + 2, n - i};
    if (i == 0) return {first + 3, n - j};
  } else {
    if (i + j == n && j < n) return {first + 1, j};
    if (i == 0) return {first + 2, n - j};
  }
  return {-1, 0};
}

inline std::int64_t TessellationLayout::number(const Topology& base, Index face, Index i, Index j) const {
  const GridPoint at = locate(base, face, i, j);
  if (at.half_edge < 0) return inside_face(face, j) + i - 1;
  if (at.from_origin == 0) return base.origin(at.half_edge);
  const Index edge = base.edge(at.half_edge);
  const bool lower = base.edge_half_edge(edge) == at.half_edge;
  return edge_start + per_edge * edge + (lower ? at.from_origin : steps - at.from_origin) - 1;
}

/// Copies what a face owns of its grid: inner points, an edge by the face of its lower half-edge, a vertex by the face
/// of its first.
template <typename Scalar>
class GridWriter {
 public:
  GridWriter(const Topology& base, const TessellationLayout& layout, Scalar* out)
      : base_(base), layout_(layout), out_(out) {}

  void write(Index face, const PieceGrid<Scalar>& grid) const {
    for_each_run(face, [&](std::int64_t vertex, std::ptrdiff_t place, std::ptrdiff_t step, std::ptrdiff_t count) {
      copy(grid, vertex, place, step, count);
    });
  }

  /// visit(first vertex, place of its point in a plane of the face's grid, step from place to place, count) for what
  /// the face owns; the vertices of a run stand in a row.
  template <typename Visit>
  void for_each_run(Index face, const Visit& visit) const {
    const Index n = layout_.steps;
    const std::ptrdiff_t width = std::ptrdiff_t{n} + 1;
    for (Index j = 1; j < n; ++j) {
      const Index inside = layout_.row_length(j) - 2;
      if (inside > 0) visit(layout_.inside_face(face, j), width * j + 1, 1, inside);
    }
    const Index first = base_.face_begin(face);
    const Index corners = layout_.quads ? 4 : 3;
    for (Index c = 0; c < corners; ++c) {
      const Index h = first + c;
      const std::ptrdiff_t here = corner_place(c);
      const std::ptrdiff_t step = (corner_place((c + 1) % corners) - here) / n;
      if (base_.vertex_half_edge(base_.origin(h)) == h) visit(std::int64_t{base_.origin(h)}, here, 1, 1);
      if (base_.edge_half_edge(base_.edge(h)) != h) continue;
      visit(layout_.edge_start + layout_.per_edge * base_.edge(h), here + step, step, n - 1);
    }
  }

 private:
  void copy(const PieceGrid<Scalar>& grid, std::int64_t vertex, std::ptrdiff_t place, std::ptrdiff_t step,
            std::ptrdiff_t count) const {
    const std::ptrdiff_t k = grid.columns;
    Scalar* __restrict to = out_ + vertex * k;
    if (k == 3) {
      const Scalar* __restrict x = grid.plane(0) + place;
      const Scalar* __restrict y = grid.plane(1) + place;
      const Scalar* __restrict z = grid.plane(2) + place;
      if (step != 1) return copy_apart(to, x, y, z, step, count);
      for (std::ptrdiff_t i = 0; i < count; ++i) {
        to[3 * i] = x[i];
        to[3 * i + 1] = y[i];
        to[3 * i + 2] = z[i];
      }
      return;
    }
    for (int c = 0; c < k; ++c) {
      const Scalar* from = grid.plane(c) + place;
      for (std::ptrdiff_t i = 0; i < count; ++i) to[k * i + c] = from[step * i];
    }
  }

  /// Three planes at points that are `step` apart.
  static void copy_apart(Scalar* __restrict to, const Scalar* __restrict x, const Scalar* __restrict y,
                         const Scalar* __restrict z, std::ptrdiff_t step, std::ptrdiff_t count) {
    for (std::ptrdiff_t i = 0; i < count; ++i, to += 3, x += step, y += step, z += step) {
      to[0] = *x;
      to[1] = *y;
      to[2] = *z;
    }
  }

  std::ptrdiff_t corner_place(Index corner) const {
    const std::ptrdiff_t n = layout_.steps;
    const std::ptrdiff_t width = n + 1;
    if (layout_.quads) return (corner == 1 || corner == 2 ? n : 0) + (corner >= 2 ? n * width : 0);
    return (corner == 1 ? n : 0) + (corner == 2 ? n * width : 0);
  }

  const Topology& base_;
  const TessellationLayout& layout_;
  Scalar* out_;
};

}  // namespace batten
