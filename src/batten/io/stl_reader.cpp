#include <algorithm>
#include <cmath>

#include "batten/io/bytes.h"
#include "batten/io/faces.h"
#include "batten/io/formats.h"
#include "batten/io/line_ends.h"
#include "batten/io/scanner.h"
#include "batten/io/vertex_welder.h"
#include "batten/progress.h"

namespace batten::io {

namespace {

constexpr std::size_t kHeaderBytes = 84;
constexpr std::size_t kTriangleBytes = 50;
constexpr std::size_t kCornersBetweenReports = std::size_t{1} << 17;

Mesh finish(const Source& source, const VertexWelder& welder, FaceList faces) {
  std::vector<FaceList> parts;
  parts.push_back(std::move(faces));
  Mesh mesh;
  join_faces(source.name, parts, mesh);
  mesh.points = welder.points();
  return mesh;
}

std::uint64_t triangle_count(std::string_view bytes) {
  return load<std::uint32_t, ByteOrder::Little>(bytes.data() + 80);
}

/// The size of a file without attribute bytes and without anything after the triangles.
std::uint64_t promised_bytes(std::string_view bytes) { return kHeaderBytes + kTriangleBytes * triangle_count(bytes); }

/// The number of attribute bytes that follow a triangle, as it says itself.
std::size_t attribute_bytes(const char* triangle) {
  return load<std::uint16_t, ByteOrder::Little>(triangle + kTriangleBytes - 2);
}

/// True if the triangles and the attribute bytes that they announce are exactly the file. Many programs keep colours
/// in the place of that number, so that it means nothing.
bool attribute_bytes_add_up(std::string_view bytes) {
  std::size_t at = kHeaderBytes;
  for (std::uint64_t left = triangle_count(bytes); left > 0; --left) {
    if (bytes.size() - at < kTriangleBytes) return false;
    const std::size_t attributes = attribute_bytes(bytes.data() + at);
    at += kTriangleBytes;
    if (bytes.size() - at < attributes) return false;
    at += attributes;
  }
  return at == bytes.size();
}

/// Whether bytes after each triangle are to be skipped. Throws Error(BadFile) if the file is too short, or has only
/// bytes that belong to no triangle.
bool has_attribute_bytes(const Source& source) {
  const std::uint64_t promised = promised_bytes(source.bytes);
  const std::uint64_t size = source.bytes.size();
  if (promised == size) return false;
  if (promised > size || triangle_count(source.bytes) == 0) {
    throw Error(ErrorCode::BadFile, source.name + ": the header promises " + std::to_string(promised) +
                                        " bytes, but the file has " + std::to_string(size) +
                                        "; it is cut short or not an STL file");
  }
  const bool add_up = attribute_bytes_add_up(source.bytes);
  note(source, std::string(add_up ? "attribute bytes of the triangles" : "bytes after the last triangle") +
                   " are skipped: " + std::to_string(size - promised));
  return add_up;
}

/// Reads triangles of a normal, three points and the number of their attribute bytes.
Mesh read_binary(const Source& source) {
  const bool attributes = has_attribute_bytes(source);
  VertexWelder welder(source.name);
  FaceList faces;
  const auto count = static_cast<std::size_t>(triangle_count(source.bytes));
  require_index_count(source.name, 3 * count, "face corners");
  faces.sizes.assign(count, 3);
  faces.vertices.resize(3 * count);
  const char* triangle = source.bytes.data() + kHeaderBytes;
  for (std::size_t corner = 0; corner < 3 * count; ++corner) {
    if (corner % kCornersBetweenReports == 0) {
      report_progress(source.progress, static_cast<double>(corner) / static_cast<double>(3 * count));
    }
    const char* at = triangle + 12 * (corner % 3 + 1);
    double point[3];
    for (int k = 0; k < 3; ++k) point[k] = double{load<float, ByteOrder::Little>(at + 4 * k)};
    if (!std::all_of(point, point + 3, [](double value) { return std::isfinite(value); })) {
      throw Fault{at, ErrorCode::NotFinite,
                  "triangle " + std::to_string(corner / 3) + " has a coordinate that is not finite; remove it"};
    }
    faces.vertices[corner] = welder.add(point);
    if (corner % 3 == 2) triangle += kTriangleBytes + (attributes ? attribute_bytes(triangle) : 0);
  }
  return finish(source, welder, std::move(faces));
}

class TextParser {
 public:
  explicit TextParser(const Source& source) : source_(source), scanner_(source.bytes), welder_(source.name) {}

  Mesh parse() {
    bool closed = false;
    while (find_token()) {
      const Scanner before = scanner_;
      const std::string keyword = lowercase(scanner_.word());
      closed = keyword == "endsolid";
      if (!statement(keyword)) before.fail_token("a word of an STL file", "statement");
    }
    if (!closed) scanner_.fail(ErrorCode::BadFile, "the file ends without endsolid; it is cut short");
    return finish(source_, welder_, std::move(faces_));
  }

 private:
  static std::string lowercase(std::string_view word) {
    std::string text(word.substr(0, 16));
    for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return text;
  }

  bool find_token() {
    while (!scanner_.next_token()) {
      if (scanner_.at_end()) return false;
      scanner_.skip_line();
    }
    return true;
  }

  bool statement(const std::string& keyword) {
    if (corners_ > 0 && keyword != "vertex" && keyword != "endloop") {
      scanner_.fail(ErrorCode::BadFile, "the vertices before " + in_quotes(keyword) + " lack an endloop; add it");
    }
    if (keyword == "vertex") {
      vertex();
    } else if (keyword == "outer") {
      corners_ = 0;
      scanner_.word();
    } else if (keyword == "endloop") {
      close_loop();
    } else if (keyword == "solid" || keyword == "endsolid") {
      scanner_.skip_line();
    } else if (keyword == "facet") {
      // The normal follows from the corners; many files have zeros or NaN here.
      for (int i = 0; i < 4; ++i) scanner_.word();
    } else {
      return keyword == "endfacet";
    }
    return true;
  }

  void vertex() {
    double point[3];
    const char* const names[] = {"x coordinate", "y coordinate", "z coordinate"};
    for (int k = 0; k < 3; ++k) point[k] = scanner_.coordinate(names[k]);
    if (faces_.vertices.size() % kCornersBetweenReports == 0) {
      const auto read = static_cast<double>(scanner_.position() - source_.bytes.data());
      report_progress(source_.progress, read / static_cast<double>(source_.bytes.size()));
    }
    faces_.vertices.push_back(welder_.add(point));
    ++corners_;
  }

  void close_loop() {
    if (corners_ < 3) {
      scanner_.fail(ErrorCode::BadFile, "a facet needs 3 vertices, this one has " + std::to_string(corners_));
    }
    faces_.sizes.push_back(corners_);
    corners_ = 0;
  }

  const Source& source_;
  Scanner scanner_;
  VertexWelder welder_;
  FaceList faces_;
  Index corners_ = 0;
};

/// Binary files may begin with "solid" too, so the size decides first: none of the four bytes of the number of
/// triangles is below 9 in a text, which makes that number too large for the file.
bool is_binary(std::string_view bytes) {
  if (bytes.size() < kHeaderBytes) return false;
  const std::uint64_t promised = promised_bytes(bytes);
  const bool like_text = std::all_of(bytes.begin() + 80, bytes.begin() + kHeaderBytes,
                                     [](char c) { return static_cast<unsigned char>(c) >= 9; });
  if (promised == bytes.size() || (promised < bytes.size() && !like_text)) return true;
  Scanner scanner(bytes);
  while (!scanner.next_token() && !scanner.at_end()) scanner.skip_line();
  const std::string_view word = scanner.word();
  return word != "solid" && word != "SOLID";
}

Mesh read_text(const Source& source) {
  return with_line_feeds(source, has_only_carriage_returns(source.bytes), [](const Source& lines) {
    try {
      return TextParser(lines).parse();
    } catch (const Fault& fault) {
      throw_at_line(lines, fault);
    }
  });
}

}  // namespace

Mesh read_stl(const Source& source) {
  if (!is_binary(source.bytes)) return read_text(source);
  try {
    return read_binary(source);
  } catch (const Fault& fault) {
    throw_at_byte(source, fault);
  }
}

}  // namespace batten::io
