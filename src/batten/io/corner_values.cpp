#include "batten/io/corner_values.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "batten/mixed_bits.h"

namespace batten::io {

bool CornerValues::equal(Index row, const double* value) const {
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  return std::equal(value, value + columns_, values_.data() + std::ptrdiff_t{columns_} * row, same);
}

std::size_t CornerValues::hash(Index vertex, const double* value) const {
  std::uint64_t all = mixed_bits(static_cast<std::uint64_t>(vertex));
  for (int k = 0; k < columns_; ++k) {
    const double unsigned_zero = value[k] + 0.0;
    std::uint64_t bits = 0;
    if (!std::isnan(unsigned_zero)) std::memcpy(&bits, &unsigned_zero, sizeof(bits));
    all = mixed_bits(all ^ bits);
  }
  return static_cast<std::size_t>(all);
}

Index CornerValues::add_row(Index vertex, const double* value) {
  values_.insert(values_.end(), value, value + columns_);
  vertices_.push_back(vertex);
  return static_cast<Index>(vertices_.size()) - 1;
}

void CornerValues::grow_table() {
  constexpr std::size_t kFirst = 64;
  const Buffer<Index> before = std::move(table_);
  table_ = Buffer<Index>(std::max(kFirst, 2 * before.size()), kNone);
  for (const Index row : before) {
    if (row == kNone) continue;
    std::size_t at = hash(vertices_[row], values_.data() + std::ptrdiff_t{columns_} * row) & (table_.size() - 1);
    while (table_[at] != kNone) at = (at + 1) & (table_.size() - 1);
    table_[at] = row;
  }
}

Index CornerValues::find_other_row(Index vertex, const double* value) {
  if (2 * (others_ + 1) > table_.size()) grow_table();
  std::size_t at = hash(vertex, value) & (table_.size() - 1);
  for (; table_[at] != kNone; at = (at + 1) & (table_.size() - 1)) {
    if (vertices_[table_[at]] == vertex && equal(table_[at], value)) return table_[at];
  }
  ++others_;
  return table_[at] = add_row(vertex, value);
}

void CornerValues::add(Index vertex, const double* value) {
  if (value == nullptr) {
    complete_ = false;
    corner_rows_.push_back(kNone);
    return;
  }
  if (static_cast<std::size_t>(vertex) >= first_.size()) first_.resize(static_cast<std::size_t>(vertex) + 1, kNone);
  if (first_[vertex] == kNone) first_[vertex] = add_row(vertex, value);
  corner_rows_.push_back(equal(first_[vertex], value) ? first_[vertex] : find_other_row(vertex, value));
}

void CornerValues::move_to(Mesh& mesh) {
  const auto rows = static_cast<Eigen::Index>(vertices_.size());
  if (rows == 0) return;
  const Values all = Eigen::Map<const Values>(values_.data(), rows, columns_).leftCols(kept_);
  // A vertex without a corner has no value, so that all would need one.
  const bool at_vertices = complete_ && others_ == 0 && rows == mesh.vertex_count();
  if (!at_vertices) {
    mesh.attributes.push_back({name_, all, std::move(corner_rows_)});
    return;
  }
  Values ordered(rows, kept_);
  for (Index vertex = 0; vertex < mesh.vertex_count(); ++vertex) ordered.row(vertex) = all.row(first_[vertex]);
  mesh.attributes.push_back({name_, std::move(ordered), {}});
}

}  // namespace batten::io
