/// \file Values at corners while a reader welds vertices that its file splits at seams.
#pragma once
#include <string>

#include "batten/mesh/mesh.h"

namespace batten::io {

/// An attribute that grows corner by corner. Corners of one vertex with equal values share a row; NaN equals NaN.
/// O(columns) a corner, whatever the valences.
class CornerValues {
 public:
  CornerValues(std::string name, int columns) : name_(std::move(name)), columns_(columns) {}

  /// Adds the value of the next corner, null where the file has none.
  void add(Index vertex, const double* value);

  /// Leaves the last column out.
  void drop_last_column() { --kept_; }

  /// Appends the attribute to a mesh with these faces, if any corner has a value: at the vertices, if all corners have
  /// values and those of a vertex are equal, otherwise at the corners.
  void move_to(Mesh& mesh);

 private:
  static constexpr Index kNone = -1;

  std::string name_;
  int columns_;
  int kept_ = columns_;
  bool equal(Index row, const double* value) const;
  std::size_t hash(Index vertex, const double* value) const;
  Index add_row(Index vertex, const double* value);
  Index find_other_row(Index vertex, const double* value);
  void grow_table();

  Buffer<double> values_;
  Buffer<Index> vertices_;  ///< of each row
  Buffer<Index> corner_rows_;
  Buffer<Index> first_;  ///< of each vertex, its first row
  Buffer<Index> table_;  ///< the other rows by their hashes, twice the room or more; a power of two
  std::size_t others_ = 0;
  bool complete_ = true;
};

}  // namespace batten::io
