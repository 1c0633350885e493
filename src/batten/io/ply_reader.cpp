#include "batten/io/chunks.h"
#include "batten/io/formats.h"
#include "batten/io/line_ends.h"
#include "batten/io/ply_binary.h"
#include "batten/io/ply_targets.h"

namespace batten::io {

namespace {

/// Reads the values of a row from the tokens of a line.
struct TextValues {
  Scanner& scanner;
  bool finite;  ///< true if the row has coordinates

  double scalar(const PlyProperty& property) {
    const bool coordinate = finite && (property.name == "x" || property.name == "y" || property.name == "z");
    return coordinate ? scanner.coordinate(property.name.c_str()) : scanner.number(property.name.c_str());
  }
  std::int64_t integer(PlyType type, const char* what) {
    if (is_integer(type)) return scanner.integer(what);
    fail(ErrorCode::BadFile, "vertices of a face have an integer type");
  }
  void skip(PlyType /*type*/, std::int64_t count) {
    for (std::int64_t i = 0; i < count; ++i) scanner.number("list entry");
  }
  [[noreturn]] void fail(ErrorCode code, const std::string& message) const { scanner.fail(code, message); }
};

/// Each value takes at least a digit and a blank. Counts that the text cannot hold are therefore refused before memory
/// is allocated.
void require_text_size(const Source& source, const PlyHeader& header, const Rows& rows) {
  auto rows_left = static_cast<std::uint64_t>(rows.count);
  auto bytes_left = static_cast<std::uint64_t>(source.bytes.data() + source.bytes.size() - header.body) + 1;
  for (const PlyElement& element : header.elements) {
    const std::uint64_t row_bytes = 2 * element.properties.size();
    if (row_bytes == 0) continue;
    if (element.count > rows_left || element.count > bytes_left / row_bytes) {
      throw Error(ErrorCode::BadFile, source.name + ": the header promises " + std::to_string(element.count) +
                                          " rows of '" + element.name +
                                          "', but the file has no room for them; it is cut short");
    }
    rows_left -= element.count;
    bytes_left -= element.count * row_bytes;
  }
}

/// The elements in order, with a line for each row.
struct ElementRows {
  const PlyTargets* targets;
  std::ptrdiff_t first_row;
  std::ptrdiff_t end_row;
};

void read_text(const Source& source, const PlyHeader& header, std::vector<PlyTargets>& targets,
               PlyFaceValues& values_of_faces, Mesh& mesh) {
  const auto offset = static_cast<std::size_t>(header.body - source.bytes.data());
  const Rows rows = find_rows(source, source.bytes.substr(offset));
  require_text_size(source, header, rows);
  std::vector<ElementRows> elements;
  for (PlyTargets& target : targets) {
    if (target.role == PlyRole::Vertices) allocate_ply_vertices(target, mesh);
    if (target.element->properties.empty()) continue;
    const std::ptrdiff_t begin = elements.empty() ? 0 : elements.back().end_row;
    elements.push_back({&target, begin, begin + static_cast<std::ptrdiff_t>(target.element->count)});
  }
  std::vector<PlyFaces> faces(rows.chunks.size());
  for_each_row(source, rows, [&](Scanner& scanner, std::ptrdiff_t row, std::size_t chunk) {
    std::size_t at = 0;
    while (at < elements.size() && row >= elements[at].end_row) ++at;
    if (at == elements.size()) {
      scanner.skip_tokens();
      return;
    }
    TextValues values{scanner, elements[at].targets->role == PlyRole::Vertices};
    read_ply_row(values, *elements[at].targets, row - elements[at].first_row, faces[chunk]);
  });
  values_of_faces.join(source.name, faces, mesh);
}

/// Tells which elements, and which properties of faces, have no place in a Mesh.
void note_skipped(const Source& source, const std::vector<PlyTargets>& targets) {
  std::string names;
  const auto add = [&](const std::string& name) { names += (names.empty() ? "" : ", ") + in_quotes(name); };
  for (const PlyTargets& target : targets) {
    const PlyElement& element = *target.element;
    if (element.count == 0) continue;
    if (target.role == PlyRole::Skipped) add(element.name);
    for (std::size_t i = 0; i < element.properties.size() && target.role != PlyRole::Skipped; ++i) {
      const PlyProperty& property = element.properties[i];
      const bool kept = target.role == PlyRole::Vertices ? !property.is_list()
                                                         : i == target.face_list || i == target.uv_list ||
                                                               i == target.exact_uv_list || i == target.texture_number;
      if (!kept) add(element.name + " " + property.name);
    }
  }
  if (!names.empty()) note(source, "elements and properties that are skipped: " + names);
}

Mesh read_ply_lines(const Source& source) {
  PlyHeader header;
  try {
    header = parse_ply_header(source);
  } catch (const Fault& fault) {
    throw_at_line(source, fault);
  }
  std::vector<PlyTargets> targets = find_ply_targets(source.name, header);
  PlyFaceValues faces;
  Mesh mesh;
  try {
    if (header.encoding == PlyEncoding::Text) {
      read_text(source, header, targets, faces, mesh);
    } else {
      read_ply_binary(source, header, targets, faces, mesh);
    }
  } catch (const Fault& fault) {
    if (header.encoding == PlyEncoding::Text) throw_at_line(source, fault);
    throw_at_byte(source, fault);
  }
  settle_ply_colors(mesh);
  faces.move_to(source, header, mesh);
  note_skipped(source, targets);
  return mesh;
}

/// The bytes whose carriage returns alone end lines: none, those of the header, or, in a text, all.
std::size_t carriage_return_bytes(std::string_view bytes) {
  const std::size_t first = bytes.find_first_of("\r\n");
  if (first == std::string_view::npos || bytes[first] == '\n' || bytes.substr(first, 2) == "\r\n") return 0;
  constexpr std::string_view kEnd = "\rend_header\r";
  const std::size_t end = bytes.find(kEnd);
  const bool text = bytes.substr(0, end).find("\rformat ascii") != std::string_view::npos;
  return text || end == std::string_view::npos ? bytes.size() : end + kEnd.size();
}

}  // namespace

Mesh read_ply(const Source& source) {
  const std::size_t converted = carriage_return_bytes(source.bytes);
  return with_line_feeds(source, converted > 0, read_ply_lines, converted);
}

}  // namespace batten::io
