/// \file The faces of a base face's grid, from the numbers of its points.
#pragma once
#include <utility>

#include "batten/tessellate/tessellation_layout.h"

namespace batten {

/// The numbers of a tessellation's vertices.
struct GridNumbering {
  const Topology& base;
  const TessellationLayout& layout;

  Index vertex(Index face, Index i, Index j) const { return layout.vertex(base, face, i, j); }
  std::int64_t inside_face(Index face, Index j) const { return layout.inside_face(face, j); }
};

/// Writes them one grid after the other, from the numbers of two rows of points at a time. Numbering has
/// vertex(face, i, j), and inside_face(face, j) for the first point inside the face in row j, where numbers run on.
template <typename Numbering>
class GridFaces {
 public:
  GridFaces(const TessellationLayout& layout, const Numbering& numbering)
      : layout_(layout), numbering_(numbering), low_(static_cast<std::size_t>(layout.steps) + 1), high_(low_.size()) {}

  void write(Index face, Index* to) {
    number(face, 0, low_);
    for (Index j = 0; j < layout_.steps; ++j) {
      number(face, j + 1, high_);
      to = layout_.quads ? write_quads(to) : write_triangles(layout_.steps - j, to);
      std::swap(low_, high_);
    }
  }

 private:
  void number(Index face, Index j, Buffer<Index>& row) const {
    const Index last = layout_.row_length(j) - 1;
    const bool inner = j > 0 && j < layout_.steps;
    row[0] = numbering_.vertex(face, 0, j);
    row[last] = numbering_.vertex(face, last, j);
    const auto first = static_cast<Index>(inner ? numbering_.inside_face(face, j) : 0);
    for (Index i = 1; i < last; ++i) row[i] = inner ? first + i - 1 : numbering_.vertex(face, i, j);
  }

  Index* write_quads(Index* __restrict to) const {
    for (Index i = 0; i < layout_.steps; ++i) {
      to[4 * i] = low_[i];
      to[4 * i + 1] = low_[i + 1];
      to[4 * i + 2] = high_[i + 1];
      to[4 * i + 3] = high_[i];
    }
    return to + 4 * layout_.steps;
  }

  /// `count` upright triangles with the turned ones between them.
  Index* write_triangles(Index count, Index* __restrict to) const {
    for (Index i = 0; i + 1 < count; ++i) {
      to[6 * i] = low_[i];
      to[6 * i + 1] = low_[i + 1];
      to[6 * i + 2] = high_[i];
      to[6 * i + 3] = high_[i + 1];
      to[6 * i + 4] = high_[i];
      to[6 * i + 5] = low_[i + 1];
    }
    to += 6 * (count - 1);
    to[0] = low_[count - 1];
    to[1] = low_[count];
    to[2] = high_[count - 1];
    return to + 3;
  }

  const TessellationLayout& layout_;
  const Numbering& numbering_;
  Buffer<Index> low_;
  Buffer<Index> high_;
};

}  // namespace batten
