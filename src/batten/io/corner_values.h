/// \file Values at corners while a reader welds vertices that its file splits at seams.
#pragma once
#include <string>

#include "batten/mesh/mesh.h"

namespace batten::io {

/// An attribute that grows corner by corner. Corners of one vertex with equal values share a row.
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
  Buffer<double> values_;
  Buffer<Index> corner_rows_;
  Buffer<Index> first_;  ///< of each vertex, its first row
  Buffer<Index> next_;   ///< of each row, the next one of its vertex
  bool complete_ = true;
  bool seams_ = false;
};

}  // namespace batten::io
