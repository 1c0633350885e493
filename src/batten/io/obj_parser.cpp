#include "batten/io/obj_parser.h"

#include <limits>
#include <utility>

namespace batten::io {

namespace {

constexpr std::size_t kPointColumns = 3;
constexpr std::size_t kUvColumns = 2;

/// Reads the lines of one piece. These statements are skipped because a Mesh has no place for them: l, p, curv, curv2
/// and surf, which are counted; vp, cstype, deg, bmat, step, parm, trim, hole, scrv, sp, end, con, mg, bevel, c_interp,
/// d_interp, lod, usemap, maplib, shadow_obj, trace_obj, ctech, stech, call, csh, and any word that OBJ does not
/// define.
class ObjParser {
 public:
  ObjParser(std::string_view text, ObjPiece& piece) : scanner_(text), piece_(piece) {}

  void run() {
    while (!scanner_.at_end()) {
      if (scanner_.next_token()) statement(scanner_.word());
      scanner_.skip_line();
    }
  }

 private:
  void statement(std::string_view keyword) {
    if (keyword == "v") {
      vertex();
    } else if (keyword == "f") {
      face();
    } else if (keyword == "vt") {
      texture_vertex();
    } else if (keyword == "vn") {
      normal();
    } else if (keyword == "t") {
      parse_obj_tag(scanner_, piece_);
    } else if (keyword == "mtllib") {
      piece_.material_libraries.push_back(scanner_.rest_of_line());
    } else if (keyword == "g" || keyword == "o" || keyword == "s" || keyword == "usemtl") {
      const auto first_face = static_cast<Index>(piece_.face_sizes.size());
      add_group(piece_.groups, {std::string(keyword), scanner_.rest_of_line(), first_face});
    } else if (keyword == "l") {
      skip(ObjSkip::Lines, keyword.data());
    } else if (keyword == "p") {
      skip(ObjSkip::Points, keyword.data());
    } else if (keyword == "curv" || keyword == "curv2" || keyword == "surf") {
      skip(ObjSkip::Curves, keyword.data());
    }
  }

  void skip(ObjSkip what, const char* where) { piece_.skipped[static_cast<std::size_t>(what)].add(where); }

  void vertex() {
    const char* const begin = scanner_.position();
    piece_.points.push_back(scanner_.coordinate("x coordinate"));
    piece_.points.push_back(scanner_.coordinate("y coordinate"));
    piece_.points.push_back(scanner_.coordinate("z coordinate"));
    if (!scanner_.next_token()) {
      note_color_columns(0);
    } else {
      vertex_extras(begin);
    }
  }

  /// Reads what follows x y z: [w], or r g b [a].
  void vertex_extras(const char* vertex) {
    double extras[4];
    int count = 0;
    for (; count < 4 && scanner_.next_token(); ++count) extras[count] = scanner_.number("vertex colour");
    if (count == 2) scanner_.fail(ErrorCode::BadFile, "a vertex has 3 numbers, 4 (w), 6 or 7 (a colour), not 5");
    expect_line_end();
    note_color_columns(count == 1 ? 0 : count);
    if (count == 1 && extras[0] != 1.0) skip(ObjSkip::Weights, vertex);
    if (count >= 3) piece_.colors.insert(piece_.colors.end(), extras, extras + count);
  }

  void note_color_columns(int columns) {
    if (!piece_.color_columns) piece_.color_columns = columns;
    if (*piece_.color_columns != columns) piece_.mixed_columns = true;
  }

  /// Reads u [v [w]]. A missing v is 0 as the format says; w belongs to volume textures and is skipped.
  void texture_vertex() {
    piece_.uvs.push_back(scanner_.number("texture coordinate u"));
    piece_.uvs.push_back(scanner_.next_token() ? scanner_.number("texture coordinate v") : 0.0);
    if (scanner_.next_token()) scanner_.number("texture coordinate w");
    expect_line_end();
  }

  void normal() {
    for (const char* name : {"normal x", "normal y", "normal z"}) piece_.normals.push_back(scanner_.number(name));
    expect_line_end();
  }

  void face() {
    const char* begin = scanner_.position();
    const std::size_t before = piece_.vertex_rows.rows.size();
    while (scanner_.next_token()) face_corner();
    const std::size_t size = piece_.vertex_rows.rows.size() - before;
    if (size < 3) {
      throw Fault{begin, ErrorCode::BadFile,
                  "a face needs 3 corners or more, this one has " + std::to_string(size) + "; remove or complete it"};
    }
    piece_.face_sizes.push_back(static_cast<Index>(size));
  }

  /// Reads i, i/j, i//k or i/j/k. An empty field means no index.
  void face_corner() {
    add_row(piece_.vertex_rows, piece_.points.size() / kPointColumns);
    const bool has_uv = scanner_.skip('/') && !scanner_.at_field_end('/');
    if (has_uv) add_optional_row(piece_.uv_rows, piece_.uvs.size() / kUvColumns);
    const bool has_normal = scanner_.skip('/') && !scanner_.at_field_end('/');
    if (has_normal) add_optional_row(piece_.normal_rows, piece_.normals.size() / kPointColumns);
    if (!has_uv && !piece_.uv_rows.rows.empty()) piece_.uv_rows.rows.push_back(CornerRows::kNone);
    if (!has_normal && !piece_.normal_rows.rows.empty()) piece_.normal_rows.rows.push_back(CornerRows::kNone);
  }

  /// Adds the row of a corner. At the first vt (vn) of a piece, the corners before it get the row -1.
  void add_optional_row(CornerRows& corners, std::size_t element_count) {
    const std::size_t earlier = piece_.vertex_rows.rows.size() - 1;
    if (corners.rows.size() < earlier) corners.rows.resize(earlier, CornerRows::kNone);
    add_row(corners, element_count);
  }

  void add_row(CornerRows& corners, std::size_t element_count) {
    const char* where = scanner_.position();
    const std::int64_t given = scanner_.integer("face corner", '/');
    if (given == 0 || given > std::numeric_limits<Index>::max() || given < -std::numeric_limits<Index>::max()) {
      throw Fault{where, ErrorCode::IndexOutOfRange,
                  "a face corner names element " + std::to_string(given) + "; OBJ counts from 1, or back from -1"};
    }
    if (given < 0) {
      corners.relative.push_back(static_cast<Index>(corners.rows.size()));
      corners.rows.push_back(static_cast<Index>(static_cast<std::int64_t>(element_count) + given));
    } else {
      corners.rows.push_back(static_cast<Index>(given - 1));
    }
  }

  void expect_line_end() {
    if (scanner_.next_token()) scanner_.fail_token("the end of the line", "after the last value");
  }

  Scanner scanner_;
  ObjPiece& piece_;
};

}  // namespace

void parse_obj(std::string_view text, ObjPiece& piece) { ObjParser(text, piece).run(); }

void add_group(std::vector<Group>& groups, Group group) {
  for (auto last = groups.rbegin(); last != groups.rend() && last->first_face == group.first_face; ++last) {
    if (last->keyword == group.keyword) {
      groups.erase(std::next(last).base());
      break;
    }
  }
  groups.push_back(std::move(group));
}

const char* find_obj_face(std::string_view text, Index face) {
  Scanner scanner(text);
  const char* where = text.data();
  for (Index seen = 0; seen <= face && !scanner.at_end();) {
    const std::string_view keyword = scanner.word();
    if (keyword == "f") {
      ++seen;
      where = keyword.data();
    }
    scanner.skip_line();
  }
  return where;
}

}  // namespace batten::io
