/// \file The destination of each value of a PLY row in a Mesh, for text and bytes alike.
#pragma once
#include <string>
#include <vector>

#include "batten/io/faces.h"
#include "batten/io/ply_header.h"
#include "batten/mesh/mesh.h"

namespace batten::io {

/// The value of row i goes to values[stride * i + offset], divided by `divisor`. It is skipped if values is null.
struct PlyColumn {
  double* values = nullptr;
  std::ptrdiff_t offset = 0;
  std::ptrdiff_t stride = 0;
  double divisor = 1.0;
};

enum class PlyRole { Vertices, Faces, Skipped };

struct PlyTargets {
  const PlyElement* element = nullptr;
  PlyRole role = PlyRole::Skipped;
  std::vector<PlyColumn> columns;  ///< one for each property
  std::size_t face_list = 0;       ///< the property that holds a face's vertices
  Index vertex_count = 0;          ///< the file's
};

/// Throws Error(BadFile) if the header lacks vertices, coordinates or corners, and Error(TooLarge). Allocates no memory
/// that depends on the counts.
std::vector<PlyTargets> find_ply_targets(const std::string& name, const PlyHeader& header);

/// Resizes mesh.points and the attributes for the vertex element, and lets the columns point there.
void allocate_ply_vertices(PlyTargets& targets, Mesh& mesh);

/// Reads one row, value by value. `RowValues` has scalar(property), coordinate(property), integer(type, what),
/// skip(type, count) and fail(code, message).
template <typename RowValues>
void read_ply_row(RowValues& values, const PlyTargets& targets, std::ptrdiff_t row, FaceList& faces) {
  const std::vector<PlyProperty>& properties = targets.element->properties;
  for (std::size_t i = 0; i < properties.size(); ++i) {
    const PlyProperty& property = properties[i];
    if (!property.is_list()) {
      const PlyColumn& column = targets.columns[i];
      const double value = values.scalar(property);
      if (column.values != nullptr) column.values[column.stride * row + column.offset] = value / column.divisor;
      continue;
    }
    const std::int64_t count = values.integer(*property.count_type, "list size");
    if (count < 0) values.fail(ErrorCode::BadFile, "a list has " + std::to_string(count) + " entries");
    if (targets.role != PlyRole::Faces || i != targets.face_list) {
      values.skip(property.type, count);
      continue;
    }
    if (count < 3)
      values.fail(ErrorCode::BadFile, "a face needs 3 corners or more, this one has " + std::to_string(count));
    for (std::int64_t k = 0; k < count; ++k) {
      const std::int64_t vertex = values.integer(property.type, "vertex of a face");
      if (vertex < 0 || vertex >= targets.vertex_count) {
        values.fail(ErrorCode::IndexOutOfRange, "a face names vertex " + std::to_string(vertex) + ", but there are " +
                                                    std::to_string(targets.vertex_count) + ", counted from 0");
      }
      faces.vertices.push_back(static_cast<Index>(vertex));
    }
    faces.sizes.push_back(static_cast<Index>(count));
  }
}

}  // namespace batten::io
