/// \file Checks before writing, so that every written file can be read.
#pragma once
#include <string>

#include "batten/mesh/mesh.h"

namespace batten::io {

/// `name` is the file's. Throws Error(NotFinite) for a coordinate or a sharpness, Error(BadShape) for offsets and
/// attributes that do not fit, Error(IndexOutOfRange), Error(DegenerateFace) for a face of fewer than three corners,
/// Error(BadArgument) for a name with a line end.
void require_writable(const std::string& name, const Mesh& mesh);

/// The attribute of that name at the vertices or at the corners, or null.
const Attribute* vertex_attribute(const Mesh& mesh, const std::string& attribute);
const Attribute* corner_attribute(const Mesh& mesh, const std::string& attribute);

/// An attribute as seen from the corners: with its own corner rows, or with its vertices' rows.
struct CornerList {
  const Attribute* attribute;

  /// The row of `attribute` at a corner, or -1.
  Index row(const Mesh& mesh, Index corner) const {
    if (attribute == nullptr) return -1;
    return attribute->per_corner() ? attribute->corner_rows[corner] : mesh.face_vertices[corner];
  }
};
/// The attribute of that name; one at the corners takes precedence over one at the vertices.
CornerList corner_list(const Mesh& mesh, const std::string& attribute);

/// Throws Error(NotFinite) if a value of the list is not finite.
void require_finite(const std::string& name, const CornerList& list);

}  // namespace batten::io
