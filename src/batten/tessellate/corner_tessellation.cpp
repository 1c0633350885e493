#include "batten/tessellate/corner_tessellation.h"

#include <algorithm>
#include <limits>
#include <string>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/tessellate/grid_faces.h"
#include "batten/tessellate/linear_in_face.h"

namespace batten {

namespace {

/// Rows as a mesh of their own: at corners, inside edges (once where both sides agree), inside faces.
class CornerNumbering {
 public:
  CornerNumbering(const Topology& base, const TessellationLayout& layout, const Attribute& attribute)
      : base_(base), layout_(layout), rows_(attribute.corner_rows), edge_first_(rows_.size()) {
    std::int64_t next = attribute.values.rows();
    for (Index h = 0; h < base.half_edge_count(); ++h) {
      const bool twins = is_twins(h);
      edge_first_[h] = twins ? edge_first_[base.twin(h)] : next;
      if (!twins) next += layout.per_edge;
    }
    face_first_ = next;
    next += layout.per_face * base.face_count();
    if (next > std::numeric_limits<Index>::max()) {
      throw Error(ErrorCode::TooLarge, "attribute '" + attribute.name + "' would have " + std::to_string(next) +
                                           " rows, more than 2^31 - 1; refine less");
    }
    count_ = static_cast<Index>(next);
  }

  Index count() const { return count_; }
  bool has_rows(Index face) const {
    const auto begin = rows_.begin() + base_.face_begin(face);
    return std::none_of(begin, begin + base_.face_size(face), [](Index row) { return row < 0; });
  }
  /// The value at a point is the business of the face that it was found in.
  bool owns(const GridPoint& at) const { return at.half_edge < 0 || (at.from_origin > 0 && !is_twins(at.half_edge)); }

  Index vertex(Index face, Index i, Index j) const {
    const GridPoint at = layout_.locate(base_, face, i, j);
    if (at.half_edge < 0) return static_cast<Index>(inside_face(face, j) + i - 1);
    if (at.from_origin == 0) return rows_[at.half_edge];
    const Index along = is_twins(at.half_edge) ? layout_.steps - at.from_origin : at.from_origin;
    return static_cast<Index>(edge_first_[at.half_edge] + along - 1);
  }
  std::int64_t inside_face(Index face, Index j) const {
    return face_first_ + layout_.inside_face(face, j) - layout_.face_start;
  }

 private:
  /// The rows along a half-edge are those of its twin, the lower one, since both sides agree.
  bool is_twins(Index h) const {
    const Index twin = base_.twin(h);
    return twin >= 0 && twin < h && rows_[h] == rows_[base_.next(twin)] && rows_[base_.next(h)] == rows_[twin];
  }

  const Topology& base_;
  const TessellationLayout& layout_;
  const Buffer<Index>& rows_;
  Buffer<std::int64_t> edge_first_;
  std::int64_t face_first_ = 0;
  Index count_ = 0;
};

/// The values that belong to a face; those of the corners are there already.
void fill_values(const Topology& base, const TessellationLayout& layout, const CornerNumbering& numbering,
                 const Attribute& attribute, Index face, Values& values) {
  const Index* rows = &attribute.corner_rows[base.face_begin(face)];
  const auto corner = [&](Index c) { return attribute.values.row(rows[c]); };
  for (Index j = 0; j <= layout.steps; ++j) {
    for (Index i = 0; i < layout.row_length(j); ++i) {
      if (!numbering.owns(layout.locate(base, face, i, j))) continue;
      const double u = static_cast<double>(i) / layout.steps;
      const double v = static_cast<double>(j) / layout.steps;
      set_linear(layout.quads, u, v, corner, values.row(numbering.vertex(face, i, j)));
    }
  }
}

}  // namespace

Attribute tessellate_corners(const Topology& base, const TessellationLayout& layout, const Buffer<Index>& face_rank,
                             const Attribute& attribute) {
  if (static_cast<Index>(attribute.corner_rows.size()) != base.half_edge_count()) {
    throw Error(ErrorCode::BadShape, "attribute '" + attribute.name + "' must have one row number per corner");
  }
  const CornerNumbering numbering(base, layout, attribute);
  const Index drawn = face_rank.empty() ? base.face_count() : *std::max_element(face_rank.begin(), face_rank.end()) + 1;
  const std::size_t per_face = static_cast<std::size_t>(layout.faces_per_face) * (layout.quads ? 4 : 3);
  Attribute result{attribute.name, Values::Zero(numbering.count(), attribute.values.cols()),
                   Buffer<Index>(per_face * static_cast<std::size_t>(drawn))};
  result.values.topRows(attribute.values.rows()) = attribute.values;
  parallel_for(base.face_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    GridFaces grids(layout, numbering);
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      const bool has_rows = numbering.has_rows(f);
      if (has_rows) fill_values(base, layout, numbering, attribute, f, result.values);
      const Index rank = face_rank.empty() ? f : face_rank[f];
      if (rank < 0) continue;
      Index* to = result.corner_rows.data() + static_cast<std::size_t>(rank) * per_face;
      if (has_rows) {
        grids.write(f, to);
      } else {
        std::fill_n(to, per_face, -1);
      }
    }
  });
  return result;
}

}  // namespace batten
