/// \file What a mesh must be to be written: a writer never makes a file that no reader takes.
#pragma once
#include <string>

#include "batten/mesh/mesh.h"

namespace batten::io {

/// Throws Error(NotFinite) for a coordinate or a sharpness, Error(BadShape) for offsets and attributes that do not fit,
/// Error(IndexOutOfRange), Error(DegenerateFace) for a face of fewer than three corners, Error(BadArgument) for a name
/// with a line end. `name` is the file's.
void require_writable(const std::string& name, const Mesh& mesh);

/// The attribute of that name at the vertices (at the corners), or null.
const Attribute* vertex_attribute(const Mesh& mesh, const std::string& attribute);
const Attribute* corner_attribute(const Mesh& mesh, const std::string& attribute);

}  // namespace batten::io
