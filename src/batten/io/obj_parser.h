/// \file The content of one piece of an OBJ file, before the pieces are joined.
#pragma once
#include <array>
#include <cstdint>
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
  /// The entries of `rows` that count from this piece's first element, because the file counts backwards there.
  Buffer<Index> relative;
};

/// An element and its position in the text.
template <typename T>
struct Tagged {
  T value;
  const char* where;
};

/// Statements of one kind that are skipped: their number, and where the first one is (null: none).
struct Skipped {
  std::int64_t count = 0;
  const char* first = nullptr;

  void add(const char* where) {
    if (count++ == 0) first = where;
  }
};

/// What an OBJ file may hold and a Mesh has no place for.
enum class ObjSkip { Weights, Lines, Points, Curves };
inline constexpr std::size_t kObjSkips = 4;

struct ObjPiece {
  Buffer<double> points;
  Buffer<double> colors;
  Buffer<double> uvs;
  Buffer<double> normals;
  /// The number of columns after x y z that every vertex of the piece has: 0 for none or w, 3 or 4 for a colour. Empty
  /// without vertices.
  std::optional<int> color_columns;
  bool mixed_columns = false;
  Buffer<Index> face_sizes;
  CornerRows vertex_rows;
  CornerRows uv_rows;      ///< empty if no corner has a vt, otherwise one entry for each corner
  CornerRows normal_rows;  ///< the same for vn
  std::vector<Group> groups;
  std::vector<std::string> material_libraries;
  std::vector<Tagged<Crease>> creases;
  std::vector<Tagged<Corner>> corners;
  std::vector<Tagged<Index>> holes;
  std::optional<BoundaryRule> boundary;
  std::optional<CreaseMethod> crease_method;
  std::optional<TriangleRule> triangle_rule;
  std::optional<FaceVaryingRule> face_varying;
  std::array<Skipped, kObjSkips> skipped;  ///< for each ObjSkip
};

/// Throws Fault.
void parse_obj(std::string_view text, ObjPiece& piece);

/// Reads what follows the `t`. The scanner is just after it, and afterwards before the end of the line.
void parse_obj_tag(Scanner& scanner, ObjPiece& piece);

/// Appends a group. A group without faces is replaced by the next one of its keyword.
void add_group(std::vector<Group>& groups, Group group);

/// The line of the piece's face number `face`, for reporting an index out of range.
const char* find_obj_face(std::string_view text, Index face);

}  // namespace batten::io
