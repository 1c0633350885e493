/// \file Faces as the parallel parts of a reader collect them.
#pragma once
#include <string>
#include <vector>

#include "batten/mesh/mesh.h"

namespace batten::io {

struct FaceList {
  Buffer<Index> sizes;
  Buffer<Index> vertices;
};

/// Appends the parts to mesh.face_offsets and mesh.face_vertices and empties them. Throws Error(TooLarge).
void join_faces(const std::string& name, std::vector<FaceList>& parts, Mesh& mesh);

}  // namespace batten::io
