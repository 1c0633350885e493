#include <algorithm>
#include <cstdint>
#include <numeric>

#include "batten/io/chunks.h"
#include "batten/io/faces.h"
#include "batten/io/formats.h"
#include "batten/io/line_ends.h"

namespace batten::io {

namespace {

/// The content of the words before the rows.
struct OffHeader {
  bool has_normals = false;  ///< N: nx ny nz after the coordinates
  bool has_uvs = false;      ///< ST: two texture coordinates at the end of the row
  std::ptrdiff_t vertex_count = 0;
  std::ptrdiff_t face_count = 0;
  std::string_view body;
};

/// Makes the line of the next token the current one.
void require_line(Scanner& scanner, const char* what) {
  while (!scanner.next_token()) {
    if (scanner.at_end()) scanner.fail_missing(what);
    scanner.skip_line();
  }
}

/// Reads ST, C and N in any order before OFF. Returns what follows OFF: counts may follow without a blank (ModelNet).
std::string_view parse_keyword(const Scanner& scanner, std::string_view word, OffHeader& header) {
  const std::size_t off = word.find("OFF");
  if (off == std::string_view::npos) {
    if (!word.empty() && word[0] >= '0' && word[0] <= '9') return word;
    scanner.fail(ErrorCode::BadFile, "an OFF file begins with the word OFF");
  }
  for (std::size_t i = 0; i < off; ++i) {
    if (word[i] == 'N') {
      header.has_normals = true;
    } else if (word.substr(i, 2) == "ST") {
      header.has_uvs = true;
      ++i;
    } else if (word[i] != 'C') {
      scanner.fail(ErrorCode::BadFile, "OFF files of other dimensions than 3 are not read");
    }
  }
  return word.substr(off + 3);
}

OffHeader parse_header(std::string_view text) {
  OffHeader header;
  Scanner scanner(text);
  require_line(scanner, "OFF keyword");
  const std::string_view rest = parse_keyword(scanner, scanner.word(), header);
  const auto consumed = static_cast<std::size_t>((rest.empty() ? scanner.position() : rest.data()) - text.data());
  Scanner counts(text.substr(consumed));
  require_line(counts, "number of vertices");
  Scanner ahead = counts;
  if (ahead.word() == "BINARY") counts.fail(ErrorCode::BadFile, "binary OFF is not read; save it as text or PLY");
  header.vertex_count = counts.integer("number of vertices");
  header.face_count = counts.integer("number of faces");
  if (counts.next_token()) counts.integer("number of edges");
  if (header.vertex_count < 0 || header.face_count < 0) counts.fail(ErrorCode::BadFile, "a count is 0 or more");
  counts.finish_line();
  header.body = text.substr(static_cast<std::size_t>(counts.position() - text.data()));
  return header;
}

/// The columns after the coordinates as attributes without rows. The first vertex determines them.
std::vector<Attribute> find_attributes(const OffHeader& header) {
  std::vector<Attribute> attributes;
  if (header.has_normals) attributes.push_back({"normal", Values(0, 3), {}});
  Scanner scanner(header.body);
  if (header.vertex_count > 0) require_line(scanner, "first vertex");
  std::ptrdiff_t columns = 0;
  while (columns < 13 && !scanner.word().empty()) ++columns;
  const std::ptrdiff_t colors = columns - 3 - (header.has_normals ? 3 : 0) - (header.has_uvs ? 2 : 0);
  if (colors > 0 && colors != 3 && colors != 4) {
    scanner.fail(ErrorCode::BadFile, "a vertex has x y z and maybe a colour of 3 or 4 numbers; correct this line");
  }
  if (colors > 0) attributes.push_back({"color", Values(0, colors), {}});
  if (header.has_uvs) attributes.push_back({"uv", Values(0, 2), {}});
  return attributes;
}

/// Reads the size and the vertices, and skips a colour. Returns true if there is one.
bool read_face(Scanner& scanner, Index vertex_count, FaceList& faces) {
  const std::int64_t size = scanner.integer("number of corners");
  if (size < 3)
    scanner.fail(ErrorCode::BadFile, "a face needs 3 corners or more, this one has " + std::to_string(size));
  for (std::int64_t i = 0; i < size; ++i) {
    const std::int64_t vertex = scanner.integer("vertex of a face");
    if (vertex < 0 || vertex >= vertex_count) {
      scanner.fail(ErrorCode::IndexOutOfRange, "a face names vertex " + std::to_string(vertex) + ", but there are " +
                                                   std::to_string(vertex_count) + ", counted from 0");
    }
    faces.vertices.push_back(static_cast<Index>(vertex));
  }
  faces.sizes.push_back(static_cast<Index>(size));
  const bool colored = scanner.next_token();
  scanner.skip_tokens();
  return colored;
}

/// Colours range from 0 to 1 or from 0 to 255; the largest number decides which.
void scale_colors(Attribute& attribute) {
  if (attribute.name != "color" || attribute.values.size() == 0 || attribute.values.maxCoeff() <= 1.0) return;
  attribute.values /= 255.0;
}

Mesh read_rows(const Source& source, const OffHeader& header) {
  require_index_count(source.name, static_cast<std::size_t>(header.vertex_count), "vertices");
  require_index_count(source.name, static_cast<std::size_t>(header.face_count), "faces");
  const Rows rows = find_rows(source, header.body);
  if (rows.count < header.vertex_count + header.face_count) {
    throw Error(ErrorCode::BadFile, source.name + ": the header promises " + std::to_string(header.vertex_count) +
                                        " vertices and " + std::to_string(header.face_count) + " faces, but only " +
                                        std::to_string(rows.count) + " lines follow; the file is cut short");
  }
  Mesh mesh;
  mesh.points.resize(header.vertex_count, 3);
  mesh.attributes = find_attributes(header);
  for (Attribute& attribute : mesh.attributes) attribute.values.resize(header.vertex_count, attribute.values.cols());
  std::vector<FaceList> faces(rows.chunks.size());
  std::vector<std::int64_t> colored(rows.chunks.size(), 0);
  for_each_row(source, rows, [&](Scanner& scanner, std::ptrdiff_t row, std::size_t chunk) {
    if (row >= header.vertex_count + header.face_count) {
      scanner.skip_tokens();
    } else if (row >= header.vertex_count) {
      colored[chunk] += read_face(scanner, mesh.vertex_count(), faces[chunk]) ? 1 : 0;
    } else {
      const char* const names[] = {"x coordinate", "y coordinate", "z coordinate"};
      for (int k = 0; k < 3; ++k) mesh.points(row, k) = scanner.coordinate(names[k]);
      for (Attribute& attribute : mesh.attributes) {
        for (double& value : attribute.values.row(row)) value = scanner.number("value of a vertex");
      }
    }
  });
  join_faces(source.name, faces, mesh);
  const std::int64_t all_colored = std::accumulate(colored.begin(), colored.end(), std::int64_t{0});
  if (all_colored > 0) note(source, "colours of faces are skipped: " + std::to_string(all_colored));
  std::for_each(mesh.attributes.begin(), mesh.attributes.end(), scale_colors);
  return mesh;
}

}  // namespace

Mesh read_off(const Source& source) {
  return with_line_feeds(source, has_only_carriage_returns(source.bytes), [](const Source& lines) {
    try {
      return read_rows(lines, parse_header(lines.bytes));
    } catch (const Fault& fault) {
      throw_at_line(lines, fault);
    }
  });
}

}  // namespace batten::io
