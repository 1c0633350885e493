#include <algorithm>
#include <cmath>
#include <set>

#include "batten/error.h"
#include "batten/io/bytes.h"
#include "batten/io/formats.h"
#include "batten/io/ply_targets.h"
#include "batten/io/text_output.h"
#include "batten/io/write_check.h"

namespace batten::io {

namespace {

enum class ColumnType { Double, Uchar };

struct Column {
  std::string name;
  const double* values;
  std::ptrdiff_t offset;
  std::ptrdiff_t stride;
  ColumnType type;

  double value(std::ptrdiff_t row) const { return values[stride * row + offset]; }
  std::uint8_t byte(std::ptrdiff_t row) const { return color_byte(value(row)); }
};

/// True if every value is exactly k / 255, as in a colour read from bytes.
bool holds_bytes(const Values& values) {
  const double* data = values.data();
  return parallel_all_of(values.size(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      if (!(data[i] >= 0.0 && data[i] <= 1.0)) return false;
      if (std::round(255.0 * data[i]) / 255.0 != data[i] || std::signbit(data[i])) return false;
    }
    return true;
  });
}

/// The property names of an attribute, without blanks, which PLY does not allow.
std::vector<std::string> property_names(const Attribute& attribute) {
  if (attribute.name == "normal") return {"nx", "ny", "nz"};
  if (attribute.name == "uv") return {"s", "t"};
  if (attribute.name == "color" && attribute.values.cols() == 3) return {"red", "green", "blue"};
  if (attribute.name == "color") return {"red", "green", "blue", "alpha"};
  std::string name = attribute.name;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == ' ' || c == '\t'; }, '_');
  if (attribute.values.cols() == 1) return {name};
  std::vector<std::string> names;
  names.reserve(static_cast<std::size_t>(attribute.values.cols()));
  for (Eigen::Index k = 0; k < attribute.values.cols(); ++k) names.push_back(name + "_" + std::to_string(k));
  return names;
}

std::vector<Column> find_columns(const std::string& file_name, const Mesh& mesh) {
  std::vector<Column> columns;
  const char* const coordinates[] = {"x", "y", "z"};
  columns.reserve(3 + mesh.attributes.size());
  for (int k = 0; k < 3; ++k) columns.push_back({coordinates[k], mesh.points.data(), k, 3, ColumnType::Double});
  for (const Attribute& attribute : mesh.attributes) {
    if (attribute.per_corner()) continue;
    const std::vector<std::string> names = property_names(attribute);
    const bool color = attribute.name == "color";
    const auto add = [&](const std::string& prefix, ColumnType type) {
      for (std::size_t k = 0; k < names.size(); ++k) {
        const auto column = static_cast<std::ptrdiff_t>(k);
        columns.push_back({prefix + names[k], attribute.values.data(), column, attribute.values.cols(), type});
      }
    };
    // Other programs expect bytes, and read numbers of other types as black.
    if (color) add("", ColumnType::Uchar);
    if (!color) add("", ColumnType::Double);
    if (color && !holds_bytes(attribute.values)) add(kPlyExactPrefix, ColumnType::Double);
  }
  std::set<std::string> names;
  for (const Column& column : columns) {
    if (!column.name.empty() && names.insert(column.name).second) continue;
    throw Error(ErrorCode::BadArgument,
                file_name + ": two vertex properties are called '" + column.name + "'; rename one");
  }
  return columns;
}

Index largest_face(const Mesh& mesh) {
  Index largest = 0;
  for (Index face = 0; face < mesh.face_count(); ++face) largest = std::max(largest, mesh.face_size(face));
  return largest;
}

/// What is written of each face.
struct FaceColumns {
  const Attribute* uvs;  ///< at corners, or null
  bool exact_uvs;        ///< true if floats do not hold them
  PlyTextures textures;
  bool short_lists;     ///< true if a byte counts the vertices of each face
  bool short_uv_lists;  ///< the same for texture coordinates
};

bool holds_floats(const Values& values) {
  const double* data = values.data();
  return parallel_all_of(values.size(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      if (static_cast<double>(static_cast<float>(data[i])) != data[i] && !std::isnan(data[i])) return false;
    }
    return true;
  });
}

FaceColumns find_face_columns(const std::string& file_name, const Mesh& mesh) {
  const Index largest = largest_face(mesh);
  const Attribute* uvs = corner_attribute(mesh, "uv");
  const bool exact = uvs != nullptr && !holds_floats(uvs->values);
  return {uvs, exact, ply_textures(file_name, mesh), largest <= 255, largest <= 127};
}

void put_list(TextBuffer& out, bool is_short, const char* type, const char* name) {
  out.put("property list ").put(std::string_view(is_short ? "uchar " : "int ")).put(std::string_view(type));
  out.put(' ').put(std::string_view(name)).put('\n');
}

void write_header(OutputFile& file, const Mesh& mesh, const std::vector<Column>& columns, const FaceColumns& faces,
                  Encoding encoding, const std::string& comment) {
  TextBuffer out;
  out.put("ply\nformat ").put(std::string_view(encoding == Encoding::Binary ? "binary_little_endian" : "ascii"));
  out.put(" 1.0\n");
  if (!comment.empty()) out.put("comment ").put(std::string_view(comment)).put('\n');
  for (const std::string& name : faces.textures.names) out.put("comment TextureFile ").put(name).put('\n');
  out.put("element vertex ").put(mesh.vertex_count()).put('\n');
  for (const Column& column : columns) {
    out.put(std::string_view(column.type == ColumnType::Uchar ? "property uchar " : "property double "));
    out.put(column.name).put('\n');
  }
  if (mesh.face_count() > 0) {
    out.put("element face ").put(mesh.face_count()).put('\n');
    put_list(out, faces.short_lists, "int", "vertex_indices");
    if (faces.uvs != nullptr) put_list(out, faces.short_uv_lists, "float", kPlyUvs);
    if (faces.exact_uvs) put_list(out, faces.short_uv_lists, "double", kPlyExactUvs);
    if (!faces.textures.numbers.empty()) out.put("property int ").put(kPlyTextureNumber).put('\n');
  }
  out.put("end_header\n");
  file.write(out.text());
}

class BinaryRow {
 public:
  explicit BinaryRow(ByteBuffer& out) : out_(out) {}
  void byte(std::uint8_t value) { out_.put(value); }
  void index(Index value) { out_.put(value); }
  void single(double value) { out_.put(static_cast<float>(value)); }
  void real(double value) { out_.put(value); }
  void count(bool is_short, Index value) {
    if (is_short) {
      byte(static_cast<std::uint8_t>(value));
    } else {
      index(value);
    }
  }
  void end() {}

 private:
  ByteBuffer& out_;
};

/// Numbers with blanks between them.
class TextRow {
 public:
  explicit TextRow(TextBuffer& out) : out_(out) {}
  void byte(std::uint8_t value) { next().put(Index{value}); }
  void index(Index value) { next().put(value); }
  void single(double value) { next().put(static_cast<double>(static_cast<float>(value))); }
  void real(double value) { next().put(value); }
  void count(bool /*is_short*/, Index value) { index(value); }
  void end() { out_.put('\n'); }

 private:
  TextBuffer& next() {
    if (!first_) out_.put(' ');
    first_ = false;
    return out_;
  }

  TextBuffer& out_;
  bool first_ = true;
};

/// A face with a corner without texture coordinates has an empty list.
template <typename Row, typename Put>
void put_uvs(Row& to, const Mesh& mesh, const FaceColumns& faces, Index face, const Put& put) {
  const Index* first = &faces.uvs->corner_rows[mesh.face_offsets[face]];
  const Index* last = first + mesh.face_size(face);
  const bool complete = std::none_of(first, last, [](Index row) { return row < 0; });
  to.count(faces.short_uv_lists, complete ? 2 * mesh.face_size(face) : 0);
  for (; complete && first != last; ++first) {
    put(faces.uvs->values(*first, 0));
    put(faces.uvs->values(*first, 1));
  }
}

template <typename Row>
void put_face(Row& to, const Mesh& mesh, const FaceColumns& faces, Index face) {
  to.count(faces.short_lists, mesh.face_size(face));
  for (Index i = mesh.face_offsets[face]; i < mesh.face_offsets[face + 1]; ++i) to.index(mesh.face_vertices[i]);
  if (faces.uvs != nullptr) put_uvs(to, mesh, faces, face, [&](double value) { to.single(value); });
  if (faces.exact_uvs) put_uvs(to, mesh, faces, face, [&](double value) { to.real(value); });
  if (!faces.textures.numbers.empty()) to.index(faces.textures.numbers[face]);
}

/// Writes the rows of both elements in the encoding of `Row`.
template <typename Row, typename Output>
void write_elements(OutputFile& file, const Mesh& mesh, const std::vector<Column>& columns, const FaceColumns& faces) {
  write_rows<Output>(file, mesh.vertex_count(), [&](Output& out, std::ptrdiff_t row) {
    Row to(out);
    for (const Column& column : columns) {
      if (column.type == ColumnType::Uchar) {
        to.byte(column.byte(row));
      } else {
        to.real(column.value(row));
      }
    }
    to.end();
  });
  write_rows<Output>(file, mesh.face_count(), [&](Output& out, std::ptrdiff_t row) {
    Row to(out);
    put_face(to, mesh, faces, static_cast<Index>(row));
    to.end();
  });
}

}  // namespace

void write_ply(OutputFile& file, const Mesh& mesh, Encoding encoding, const std::string& comment) {
  const std::vector<Column> columns = find_columns(file.name(), mesh);
  const FaceColumns faces = find_face_columns(file.name(), mesh);
  file.expect_rows(std::ptrdiff_t{mesh.vertex_count()} + mesh.face_count());
  write_header(file, mesh, columns, faces, encoding, comment);
  if (encoding == Encoding::Binary) {
    write_elements<BinaryRow, ByteBuffer>(file, mesh, columns, faces);
  } else {
    write_elements<TextRow, TextBuffer>(file, mesh, columns, faces);
  }
}

}  // namespace batten::io
