/// \file The destination of each value of a PLY row in a Mesh, for text and bytes alike.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "batten/io/ply_faces.h"
#include "batten/io/ply_header.h"
#include "batten/mesh/mesh.h"

namespace batten::io {

/// Colours that are not all k/255 are written twice: as bytes for other programs, and as doubles in properties whose
/// names begin with this, which the reader prefers as long as the bytes agree with them.
inline constexpr const char* kPlyExactPrefix = "exact_";

/// The nearest byte of a colour in [0, 1]; less and NaN are 0, more is 255.
inline std::uint8_t color_byte(double value) {
  return value > 0.0 ? static_cast<std::uint8_t>(std::lround(255.0 * std::min(value, 1.0))) : std::uint8_t{0};
}

/// The value of row i goes to values[stride * i + offset], divided by `divisor`. It is skipped if values is null.
struct PlyColumn {
  double* values = nullptr;
  std::ptrdiff_t offset = 0;
  std::ptrdiff_t stride = 0;
  double divisor = 1.0;
};

enum class PlyRole { Vertices, Faces, Strips, Skipped };

struct PlyTargets {
  const PlyElement* element = nullptr;
  PlyRole role = PlyRole::Skipped;
  std::vector<PlyColumn> columns;  ///< one for each property
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  std::size_t face_list = kNone;  ///< the property that holds the vertices of a face or a strip
  std::size_t uv_list = kNone;    ///< those of faces that PlyFaces keeps
  std::size_t exact_uv_list = kNone;
  std::size_t texture_number = kNone;
  Index vertex_count = 0;  ///< the file's
};

/// Throws Error(BadFile) if the header lacks vertices, coordinates or corners, and Error(TooLarge). Allocates no memory
/// that depends on the counts.
std::vector<PlyTargets> find_ply_targets(const std::string& name, const PlyHeader& header);

/// Resizes mesh.points and the attributes for the vertex element, and lets the columns point there.
void allocate_ply_vertices(PlyTargets& targets, Mesh& mesh);

/// Makes the exact colours that were read the mesh's colours, unless another program has changed the bytes.
void settle_ply_colors(Mesh& mesh);

/// Reads a vertex of a face, or of a strip, in which -1 may stand.
template <typename RowValues>
Index read_ply_vertex(RowValues& values, PlyType type, Index vertex_count, std::int64_t least) {
  const std::int64_t vertex = values.integer(type, "vertex of a face");
  if (vertex < least || vertex >= vertex_count) {
    values.fail(ErrorCode::IndexOutOfRange, "a face names vertex " + std::to_string(vertex) + ", but there are " +
                                                std::to_string(vertex_count) + ", counted from 0");
  }
  return static_cast<Index>(vertex);
}

template <typename RowValues>
void read_ply_face(RowValues& values, PlyType type, std::int64_t count, Index vertex_count, FaceList& faces) {
  if (count < 3)
    values.fail(ErrorCode::BadFile, "a face needs 3 corners or more, this one has " + std::to_string(count));
  for (std::int64_t k = 0; k < count; ++k) faces.vertices.push_back(read_ply_vertex(values, type, vertex_count, 0));
  faces.sizes.push_back(static_cast<Index>(count));
}

/// Reads a triangle strip: each vertex forms a triangle with the two before it, the second, fourth and so on of them
/// turned over, so that all have one orientation. -1 begins a new strip. Triangles that name a vertex twice are left
/// out: they only lead the strip to another place.
template <typename RowValues>
void read_ply_strip(RowValues& values, PlyType type, std::int64_t count, Index vertex_count, FaceList& faces) {
  Index before[2] = {-1, -1};
  bool turned = false;
  for (std::int64_t k = 0; k < count; ++k) {
    const Index vertex = read_ply_vertex(values, type, vertex_count, -1);
    if (vertex >= 0 && before[0] >= 0) {
      if (vertex != before[0] && vertex != before[1] && before[0] != before[1]) {
        for (const Index corner : {before[turned ? 1 : 0], before[turned ? 0 : 1], vertex}) {
          faces.vertices.push_back(corner);
        }
        faces.sizes.push_back(3);
      }
      turned = !turned;
    }
    before[0] = vertex < 0 ? -1 : before[1];
    before[1] = vertex;
    if (vertex < 0) turned = false;
  }
}

/// Reads a list of numbers.
template <typename RowValues>
void read_ply_numbers(RowValues& values, const PlyProperty& property, std::int64_t count, Buffer<double>& numbers) {
  for (std::int64_t k = 0; k < count; ++k) numbers.push_back(values.scalar(property));
}

/// Reads one row, value by value. `RowValues` has scalar(property), coordinate(property), integer(type, what),
/// skip(type, count) and fail(code, message).
template <typename RowValues>
void read_ply_row(RowValues& values, const PlyTargets& targets, std::ptrdiff_t row, PlyFaces& faces) {
  const std::vector<PlyProperty>& properties = targets.element->properties;
  double texture = PlyFaces::kNoTexture;
  for (std::size_t i = 0; i < properties.size(); ++i) {
    const PlyProperty& property = properties[i];
    if (!property.is_list()) {
      const PlyColumn& column = targets.columns[i];
      const double value = values.scalar(property);
      if (column.values != nullptr) column.values[column.stride * row + column.offset] = value / column.divisor;
      if (i == targets.texture_number) texture = value;
      continue;
    }
    const std::int64_t count = values.integer(*property.count_type, "list size");
    if (count < 0) values.fail(ErrorCode::BadFile, "a list has " + std::to_string(count) + " entries");
    if (i == targets.face_list && targets.role == PlyRole::Faces) {
      read_ply_face(values, property.type, count, targets.vertex_count, faces.list);
    } else if (i == targets.face_list) {
      read_ply_strip(values, property.type, count, targets.vertex_count, faces.list);
    } else if (i == targets.uv_list) {
      read_ply_numbers(values, property, count, faces.uvs.row);
    } else if (i == targets.exact_uv_list) {
      read_ply_numbers(values, property, count, faces.exact_uvs.row);
    } else {
      values.skip(property.type, count);
    }
  }
  if (targets.role != PlyRole::Faces) return;
  const auto is_there = [](std::size_t property) { return property != PlyTargets::kNone; };
  faces.end_row(is_there(targets.uv_list), is_there(targets.exact_uv_list), is_there(targets.texture_number), texture);
}

}  // namespace batten::io
