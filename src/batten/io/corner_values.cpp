#include "batten/io/corner_values.h"

#include <algorithm>
#include <utility>

namespace batten::io {

void CornerValues::add(Index vertex, const double* value) {
  if (value == nullptr) {
    complete_ = false;
    corner_rows_.push_back(kNone);
    return;
  }
  if (static_cast<std::size_t>(vertex) >= first_.size()) first_.resize(static_cast<std::size_t>(vertex) + 1, kNone);
  Index last = kNone;
  Index row = first_[vertex];
  const auto equal = [&](Index at) {
    return std::equal(value, value + columns_, values_.data() + std::ptrdiff_t{columns_} * at);
  };
  while (row != kNone && !equal(row)) {
    last = row;
    row = next_[row];
  }
  if (row == kNone) {
    row = static_cast<Index>(next_.size());
    values_.insert(values_.end(), value, value + columns_);
    next_.push_back(kNone);
    (last == kNone ? first_[vertex] : next_[last]) = row;
    seams_ = seams_ || last != kNone;
  }
  corner_rows_.push_back(row);
}

void CornerValues::move_to(Mesh& mesh) {
  const auto rows = static_cast<Eigen::Index>(next_.size());
  if (rows == 0) return;
  const Values all = Eigen::Map<const Values>(values_.data(), rows, columns_).leftCols(kept_);
  // A vertex without a corner has no value, so that all would need one.
  const bool at_vertices = complete_ && !seams_ && rows == mesh.vertex_count();
  if (!at_vertices) {
    mesh.attributes.push_back({name_, all, std::move(corner_rows_)});
    return;
  }
  Values ordered(rows, kept_);
  for (Index vertex = 0; vertex < mesh.vertex_count(); ++vertex) ordered.row(vertex) = all.row(first_[vertex]);
  mesh.attributes.push_back({name_, std::move(ordered), {}});
}

}  // namespace batten::io
