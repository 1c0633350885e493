/// \file What one piece of an OBJ file says, before the pieces know of each other.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "batten/io/scanner.h"
#include "batten/mesh/mesh.h"

namespace batten::io {

/// The rows (0-based) that corners name in one of the lists v, vt, vn.
struct CornerRows {
  static constexpr Index kNone = -1;

  Buffer<Index> rows;
  /// Entries of `rows` that count from this piece's first element, since the file counted backwards.
  Buffer<Index> relative;
};

/// An element with the place that speaks of it.
template <typename T>
struct Tagged {
  T value;
  const char* where;
};

struct ObjPiece {
  Buffer<double> points;
  Buffer<double> colors;
  Buffer<double> uvs;
  Buffer<double> normals;
  /// Numbers after x y z that every vertex of the piece has: 0 none or w, 3 or 4 a colour, nothing without a vertex.
  std::optional<int> color_columns;
  bool mixed_columns = false;
  Buffer<Index> face_sizes;
  CornerRows vertex_rows;
  CornerRows uv_rows;      ///< empty where no corner has a vt, else one entry per corner
  CornerRows normal_rows;  ///< likewise
  std::vector<Group> groups;
  std::vector<std::string> material_libraries;
  std::vector<Tagged<Crease>> creases;
  std::vector<Tagged<Corner>> corners;
  std::vector<Tagged<Index>> holes;
  std::optional<BoundaryRule> boundary;
  std::optional<CreaseMethod> crease_method;
  std::optional<TriangleRule> triangle_rule;
};

/// Throws Fault.
void parse_obj(std::string_view text, ObjPiece& piece);

/// Reads what follows the `t`; the scanner stands behind it and is left before the end of the line.
void parse_obj_tag(Scanner& scanner, ObjPiece& piece);

/// Appends a group; one that held no face is replaced by the next of its keyword.
void add_group(std::vector<Group>& groups, Group group);

/// The line of the piece's face number `face`: where an index out of range is reported.
const char* find_obj_face(std::string_view text, Index face);

}  // namespace batten::io
