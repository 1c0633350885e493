#include <algorithm>
#include <iterator>
#include <limits>

#include "batten/io/chunks.h"
#include "batten/io/faces.h"
#include "batten/io/formats.h"
#include "batten/io/line_ends.h"
#include "batten/io/obj_parser.h"

namespace batten::io {

namespace {

using Pieces = std::vector<ObjPiece>;
using Texts = std::vector<std::string_view>;

/// The number of elements of a list before each piece; the last entry is the total.
template <typename Count>
std::vector<Index> first_elements(const Source& source, const Pieces& pieces, const char* elements,
                                  const Count& count) {
  std::vector<std::size_t> first(1, 0);
  for (const ObjPiece& piece : pieces) first.push_back(first.back() + count(piece));
  require_index_count(source.name, first.back(), elements);
  return {first.begin(), first.end()};
}

/// Joins the rows of one list of all pieces and frees the pieces' own.
template <typename Matrix>
Matrix join_values(Pieces& pieces, Buffer<double> ObjPiece::*list, const std::vector<Index>& first, int columns) {
  Matrix values(first.back(), columns);
  parallel_for_each(static_cast<std::ptrdiff_t>(pieces.size()), [&](std::ptrdiff_t i) {
    const Buffer<double> part = std::move(pieces[i].*list);
    std::copy(part.begin(), part.end(), values.data() + std::ptrdiff_t{columns} * first[i]);
  });
  return values;
}

/// Makes the rows of one piece count from the file's first element. Returns the first corner that is out of range, or
/// -1.
std::ptrdiff_t resolve_rows(CornerRows& corners, Index first_element, Index element_count, bool optional) {
  constexpr Index kBad = std::numeric_limits<Index>::min();
  for (const Index corner : corners.relative) {
    const std::int64_t row = std::int64_t{corners.rows[corner]} + first_element;
    corners.rows[corner] = row < 0 ? kBad : static_cast<Index>(row);
  }
  const auto bad = std::find_if(corners.rows.begin(), corners.rows.end(), [&](Index row) {
    return static_cast<std::uint32_t>(row) >= static_cast<std::uint32_t>(element_count) &&
           !(optional && row == CornerRows::kNone);
  });
  return bad == corners.rows.end() ? -1 : bad - corners.rows.begin();
}

Index face_of_corner(const ObjPiece& piece, std::ptrdiff_t corner) {
  Index face = 0;
  for (std::ptrdiff_t end = piece.face_sizes[0]; end <= corner; end += piece.face_sizes[++face]) {
  }
  return face;
}

struct List {
  CornerRows ObjPiece::*rows;
  const std::vector<Index>& first;
  const char* name;
  bool optional;
};

/// Reports for each piece its first line with an index out of range.
void resolve_corners(const Source& source, const Texts& texts, Pieces& pieces, const std::vector<List>& lists) {
  const auto resolve = [&](std::size_t i) {
    Index first_bad_face = std::numeric_limits<Index>::max();
    const List* bad_list = nullptr;
    for (const List& list : lists) {
      const std::ptrdiff_t bad = resolve_rows(pieces[i].*list.rows, list.first[i], list.first.back(), list.optional);
      if (bad < 0) continue;
      const Index face = face_of_corner(pieces[i], bad);
      if (face < first_bad_face) bad_list = &list;
      first_bad_face = std::min(first_bad_face, face);
    }
    if (bad_list == nullptr) return;
    throw Fault{find_obj_face(texts[i], first_bad_face), ErrorCode::IndexOutOfRange,
                std::string("a face corner names a `") + bad_list->name + "` that does not exist; there are " +
                    std::to_string(bad_list->first.back())};
  };
  for_each_chunk(pieces.size(), resolve, progress_within(source.progress, 0.9, 1.0));
}

void join_vertices(const Source& source, Pieces& pieces, const std::vector<Index>& first, Mesh& mesh) {
  mesh.points = join_values<Points>(pieces, &ObjPiece::points, first, 3);
  int columns = -1;
  bool mixed = false;
  std::size_t count = 0;
  for (const ObjPiece& piece : pieces) {
    count += piece.colors.size();
    if (!piece.color_columns) continue;
    if (columns < 0) columns = *piece.color_columns;
    mixed = mixed || piece.mixed_columns || columns != *piece.color_columns;
  }
  if (columns <= 0 || mixed) return;
  require_index_count(source.name, count / static_cast<std::size_t>(columns), "colours");
  mesh.attributes.push_back({"color", join_values<Values>(pieces, &ObjPiece::colors, first, columns), {}});
}

/// Corners with the same vt share a row in the attribute too. Rows without corners are kept. A list without corners is
/// dropped, except in a file without faces, where a list as long as the vertices belongs to them.
void join_attribute(Pieces& pieces, Buffer<double> ObjPiece::*list, CornerRows ObjPiece::*rows,
                    const std::vector<Index>& first, const std::vector<Index>& first_corner, Attribute attribute,
                    Mesh& mesh) {
  const bool used =
      std::any_of(pieces.begin(), pieces.end(), [&](const ObjPiece& piece) { return !(piece.*rows).rows.empty(); });
  const bool per_vertex = first_corner.back() == 0 && first.back() > 0 && first.back() == mesh.vertex_count();
  if (!used && !per_vertex) return;
  const auto columns = static_cast<int>(attribute.values.cols());
  attribute.values = join_values<Values>(pieces, list, first, columns);
  if (used) attribute.corner_rows.resize(static_cast<std::size_t>(first_corner.back()));
  parallel_for_each(used ? static_cast<std::ptrdiff_t>(pieces.size()) : 0, [&](std::ptrdiff_t i) {
    const Buffer<Index> part = std::move((pieces[i].*rows).rows);
    Index* begin = attribute.corner_rows.data() + first_corner[i];
    Index* end = attribute.corner_rows.data() + first_corner[i + 1];
    std::fill(std::copy(part.begin(), part.end(), begin), end, CornerRows::kNone);
  });
  mesh.attributes.push_back(std::move(attribute));
}

template <typename T>
void append(std::vector<T>& all, std::vector<T>& part) {
  std::move(part.begin(), part.end(), std::back_inserter(all));
}

/// Finds the first line whose tag names a missing element, in whatever order the tags are checked.
class TagCheck {
 public:
  void require(Index element, Index count, const char* elements, const char* where) {
    if (element < count || (first_ && first_->where <= where)) return;
    first_ = Fault{where, ErrorCode::IndexOutOfRange,
                   "the tag names " + std::to_string(element) + ", but there are " + std::to_string(count) + " " +
                       elements + ", counted from 0"};
  }
  void finish() const {
    if (first_) throw Fault(*first_);
  }

 private:
  std::optional<Fault> first_;
};

/// The last choice in the file counts.
template <typename T>
void keep_last(std::optional<T>& kept, const std::optional<T>& later) {
  if (later) kept = later;
}

void join_tags(Pieces& pieces, const std::vector<Index>& first_face, Mesh& mesh) {
  const Index vertices = mesh.vertex_count();
  TagCheck check;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    ObjPiece& piece = pieces[i];
    for (const Tagged<Crease>& crease : piece.creases) {
      check.require(std::max(crease.value.a, crease.value.b), vertices, "vertices", crease.where);
      mesh.creases.push_back(crease.value);
    }
    for (const Tagged<Corner>& corner : piece.corners) {
      check.require(corner.value.vertex, vertices, "vertices", corner.where);
      mesh.corners.push_back(corner.value);
    }
    for (const Tagged<Index>& hole : piece.holes) {
      check.require(hole.value, first_face.back(), "faces", hole.where);
      mesh.holes.push_back(hole.value);
    }
    for (Group& group : piece.groups) {
      group.first_face += first_face[i];
      add_group(mesh.groups, std::move(group));
    }
    append(mesh.material_libraries, piece.material_libraries);
    keep_last(mesh.boundary, piece.boundary);
    keep_last(mesh.crease_method, piece.crease_method);
    keep_last(mesh.triangle_rule, piece.triangle_rule);
    keep_last(mesh.face_varying, piece.face_varying);
  }
  check.finish();
}

void join_obj_faces(const Source& source, Pieces& pieces, Mesh& mesh) {
  std::vector<FaceList> parts(pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    parts[i].sizes = std::move(pieces[i].face_sizes);
    parts[i].vertices = std::move(pieces[i].vertex_rows.rows);
  }
  join_faces(source.name, parts, mesh);
}

Mesh join(const Source& source, const Texts& texts, Pieces& pieces) {
  const auto counts = [&](const char* elements, auto count) { return first_elements(source, pieces, elements, count); };
  const auto vertices = counts("vertices", [](const ObjPiece& piece) { return piece.points.size() / 3; });
  const auto uvs = counts("texture vertices", [](const ObjPiece& piece) { return piece.uvs.size() / 2; });
  const auto normals = counts("normals", [](const ObjPiece& piece) { return piece.normals.size() / 3; });
  const auto faces = counts("faces", [](const ObjPiece& piece) { return piece.face_sizes.size(); });
  const auto corners = counts("face corners", [](const ObjPiece& piece) { return piece.vertex_rows.rows.size(); });
  if (vertices.back() == 0) {
    throw Error(ErrorCode::BadFile, source.name + ": no vertices (`v x y z`) in it; is this an OBJ file?");
  }
  resolve_corners(source, texts, pieces,
                  {{&ObjPiece::vertex_rows, vertices, "v", false},
                   {&ObjPiece::uv_rows, uvs, "vt", true},
                   {&ObjPiece::normal_rows, normals, "vn", true}});
  Mesh mesh;
  join_vertices(source, pieces, vertices, mesh);
  join_attribute(pieces, &ObjPiece::uvs, &ObjPiece::uv_rows, uvs, corners, {"uv", Values(0, 2), {}}, mesh);
  join_attribute(pieces, &ObjPiece::normals, &ObjPiece::normal_rows, normals, corners, {"normal", Values(0, 3), {}},
                 mesh);
  join_obj_faces(source, pieces, mesh);
  join_tags(pieces, faces, mesh);
  return mesh;
}

/// Tells the skipped statements of all pieces, with the line of the first one of each kind.
void note_skipped(const Source& source, const Pieces& pieces) {
  constexpr const char* kWhat[kObjSkips] = {"weights w other than 1", "lines (`l`)", "points (`p`)",
                                            "curves and free-form surfaces (`curv`, `surf`)"};
  for (std::size_t kind = 0; kind < kObjSkips; ++kind) {
    Skipped all;
    for (const ObjPiece& piece : pieces) {
      const Skipped& skipped = piece.skipped[kind];
      if (all.count == 0) all.first = skipped.first;
      all.count += skipped.count;
    }
    if (all.count == 0) continue;
    const std::string line = std::to_string(line_number(source, all.first));
    note(source,
         std::string(kWhat[kind]) + " are skipped: " + std::to_string(all.count) + " (the first in line " + line + ")");
  }
}

/// Reports the first of several wrong lines. Indices are checked after every line has been read.
Mesh read_obj_lines(const Source& source) {
  try {
    const Texts texts = cut_lines(source.bytes, source.chunk_bytes);
    Pieces pieces(texts.size());
    const auto parse = [&](std::size_t i) { parse_obj(texts[i], pieces[i]); };
    for_each_chunk(pieces.size(), parse, progress_within(source.progress, 0.0, 0.9));
    note_skipped(source, pieces);
    return join(source, texts, pieces);
  } catch (const Fault& fault) {
    throw_at_line(source, fault);
  }
}

}  // namespace

Mesh read_obj(const Source& source) {
  return with_line_feeds(source, has_only_carriage_returns(source.bytes), read_obj_lines);
}

}  // namespace batten::io
