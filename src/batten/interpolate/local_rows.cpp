#include "batten/interpolate/local_rows.h"

namespace batten {

LocalRows::LocalRows(const LimitMatrix& matrix)
    : matrix_(&matrix), place_of_(static_cast<std::size_t>(matrix.topology().vertex_count()), -1) {}

Index LocalRows::place_of(Index vertex) {
  Index& place = place_of_[vertex];
  if (place < 0) {
    place = size();
    vertices_.push_back(vertex);
    extents_.emplace_back();
  }
  return place;
}

std::span<const LocalRows::Entry> LocalRows::row(Index place) {
  if (!has_row(place)) build(place);
  const Extent& extent = extents_[place];
  return {entries_.data() + extent.begin, static_cast<std::size_t>(extent.end - extent.begin)};
}

double LocalRows::diagonal(Index place) {
  if (!has_row(place)) build(place);
  return extents_[place].diagonal;
}

void LocalRows::build(Index place) {
  const Index v = vertex(place);
  Extent extent;
  extent.begin = static_cast<Index>(entries_.size());
  matrix_->visit_row(v, [&](Index column, double weight) {
    entries_.push_back({place_of(column), weight});
    if (column == v) extent.diagonal += weight;
  });
  if (matrix_->row_kind(v) != LimitRow::Smooth) {
    const Topology& topology = matrix_->topology();
    topology.for_each_outgoing(v, [&](Index h) {
      const Index f = topology.face(h);
      for (Index i = topology.face_begin(f); i < topology.face_end(f); ++i) {
        entries_.push_back({place_of(topology.origin(i)), 0.0});
      }
    });
  }
  extent.end = static_cast<Index>(entries_.size());
  extents_[place] = extent;
}

void LocalRows::clear() {
  for (const Index v : vertices_) place_of_[v] = -1;
  vertices_.clear();
  extents_.clear();
  entries_.clear();
}

}  // namespace batten
