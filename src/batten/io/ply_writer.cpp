#include <algorithm>
#include <cmath>
#include <set>

#include "batten/error.h"
#include "batten/io/bytes.h"
#include "batten/io/formats.h"
#include "batten/io/ply_targets.h"
#include "batten/io/text_output.h"

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

void write_header(OutputFile& file, const Mesh& mesh, const std::vector<Column>& columns, bool short_lists,
                  Encoding encoding) {
  TextBuffer out;
  out.put("ply\nformat ").put(std::string_view(encoding == Encoding::Binary ? "binary_little_endian" : "ascii"));
  out.put(" 1.0\nelement vertex ").put(mesh.vertex_count()).put('\n');
  for (const Column& column : columns) {
    out.put(std::string_view(column.type == ColumnType::Uchar ? "property uchar " : "property double "));
    out.put(column.name).put('\n');
  }
  if (mesh.face_count() > 0) {
    out.put("element face ").put(mesh.face_count()).put("\nproperty list ");
    out.put(std::string_view(short_lists ? "uchar" : "int")).put(" int vertex_indices\n");
  }
  out.put("end_header\n");
  file.write(out.text());
}

void write_binary(OutputFile& file, const Mesh& mesh, const std::vector<Column>& columns, bool short_lists) {
  write_rows<ByteBuffer>(file, mesh.vertex_count(), [&](ByteBuffer& out, std::ptrdiff_t row) {
    for (const Column& column : columns) {
      if (column.type == ColumnType::Uchar) {
        out.put(column.byte(row));
      } else {
        out.put(column.value(row));
      }
    }
  });
  write_rows<ByteBuffer>(file, mesh.face_count(), [&](ByteBuffer& out, std::ptrdiff_t row) {
    const auto face = static_cast<Index>(row);
    if (short_lists) {
      out.put(static_cast<std::uint8_t>(mesh.face_size(face)));
    } else {
      out.put(mesh.face_size(face));
    }
    for (Index i = mesh.face_offsets[face]; i < mesh.face_offsets[face + 1]; ++i) out.put(mesh.face_vertices[i]);
  });
}

void write_text(OutputFile& file, const Mesh& mesh, const std::vector<Column>& columns) {
  write_rows<TextBuffer>(file, mesh.vertex_count(), [&](TextBuffer& out, std::ptrdiff_t row) {
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (k > 0) out.put(' ');
      if (columns[k].type == ColumnType::Uchar) {
        out.put(Index{columns[k].byte(row)});
      } else {
        out.put(columns[k].value(row));
      }
    }
    out.put('\n');
  });
  write_face_rows(file, mesh);
}

}  // namespace

void write_ply(OutputFile& file, const Mesh& mesh, Encoding encoding) {
  const std::vector<Column> columns = find_columns(file.name(), mesh);
  const bool short_lists = largest_face(mesh) <= 255;
  file.expect_rows(std::ptrdiff_t{mesh.vertex_count()} + mesh.face_count());
  write_header(file, mesh, columns, short_lists, encoding);
  if (encoding == Encoding::Binary) {
    write_binary(file, mesh, columns, short_lists);
  } else {
    write_text(file, mesh, columns);
  }
}

}  // namespace batten::io
