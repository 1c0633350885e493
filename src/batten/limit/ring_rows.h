/// \file Rows of the limit matrix that differ in their columns only.
#pragma once
#include "batten/limit/limit_matrix.h"

namespace batten {

/// A number from 1 on that tells the weights of a smooth row among quads under Catmull-Clark or triangles under Loop:
/// rows of the same number have the same weights in the order of LimitMatrix::visit_row(). 0 for other rows.
inline Index ring_key(const LimitMatrix& matrix, Index vertex) {
  constexpr Index kMostFaces = 254;
  const Index preferred_size = matrix.scheme().kind == SchemeKind::CatmullClark ? 4 : 3;
  if (matrix.topology().uniform_face_size() != preferred_size || matrix.row_kind(vertex) != LimitRow::Smooth) return 0;
  const Index faces = matrix.face_count(vertex);
  if (faces > kMostFaces) return 0;
  const double alpha = matrix.alpha(vertex);
  if (alpha == matrix.scheme().alpha) return faces;
  return alpha == kValenceTwoAlpha ? kMostFaces + faces : 0;
}

/// Writes the columns of a row with a ring_key() in the order of LimitMatrix::visit_row(), but for the last, which is
/// the vertex itself: 2 n of them under Catmull-Clark, n under Loop, where n faces surround the vertex.
inline void ring_columns(const LimitMatrix& matrix, Index vertex, Index* columns) {
  const Topology& topology = matrix.topology();
  const Index start = topology.vertex_half_edge(vertex);
  Index h = start;
  if (matrix.scheme().kind == SchemeKind::CatmullClark) {
    do {
      const Index first = h & ~3;
      *columns++ = topology.origin(first | ((h + 1) & 3));
      *columns++ = topology.origin(first | ((h + 2) & 3));
      h = topology.twin(first | ((h + 3) & 3));
    } while (h != start);
  } else {
    do {
      const Index corner = h % 3;
      *columns++ = topology.origin(corner == 2 ? h - 2 : h + 1);
      h = topology.twin(corner == 0 ? h + 2 : h - 1);
    } while (h != start);
  }
}

}  // namespace batten
