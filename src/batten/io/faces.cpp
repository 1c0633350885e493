#include "batten/io/faces.h"

#include <algorithm>

#include "batten/io/source.h"
#include "batten/parallel/parallel.h"

namespace batten::io {

void join_faces(const std::string& name, std::vector<FaceList>& parts, Mesh& mesh) {
  std::vector<std::size_t> first_face(1, static_cast<std::size_t>(mesh.face_count()));
  std::vector<std::size_t> first_corner(1, mesh.face_vertices.size());
  for (const FaceList& part : parts) {
    first_face.push_back(first_face.back() + part.sizes.size());
    first_corner.push_back(first_corner.back() + part.vertices.size());
  }
  require_index_count(name, first_face.back(), "faces");
  require_index_count(name, first_corner.back(), "face corners");
  mesh.face_offsets.resize(first_face.back() + 1);
  mesh.face_vertices.resize(first_corner.back());
  parallel_for_each(static_cast<std::ptrdiff_t>(parts.size()), [&](std::ptrdiff_t i) {
    const FaceList part = std::move(parts[i]);
    auto end = static_cast<Index>(first_corner[i]);
    Index* offset = mesh.face_offsets.data() + first_face[i] + 1;
    for (const Index size : part.sizes) *offset++ = end += size;
    std::copy(part.vertices.begin(), part.vertices.end(), mesh.face_vertices.begin() + first_corner[i]);
  });
}

}  // namespace batten::io
