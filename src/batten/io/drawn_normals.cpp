#include "batten/io/drawn_normals.h"

#include "batten/mesh/face_normal.h"

namespace batten::io {

Buffer<std::uint8_t> hidden_faces(const Mesh& mesh) {
  Buffer<std::uint8_t> hidden(static_cast<std::size_t>(mesh.face_count()), 0);
  for (const Index face : mesh.holes) hidden[face] = 1;
  return hidden;
}

DrawnNormals::DrawnNormals(const std::string& name, const Mesh& mesh, const Buffer<std::uint8_t>& hidden)
    : mesh_(mesh), own_(corner_list(mesh, "normal")) {
  require_finite(name, own_);
  bool complete = true;
  for (Index corner = 0; complete && corner < static_cast<Index>(mesh.face_vertices.size()); ++corner) {
    complete = is_given(own_.row(mesh, corner));
  }
  if (complete) return;
  smooth_ = Points::Zero(mesh.vertex_count(), 3);
  for (Index face = 0; face < mesh.face_count(); ++face) {
    if (hidden[face] != 0) continue;
    const Eigen::RowVector3d normal = face_normal(mesh, face).transpose();
    for (Index corner = mesh.face_offsets[face]; corner < mesh.face_offsets[face + 1]; ++corner) {
      smooth_.row(mesh.face_vertices[corner]) += normal;
    }
  }
}

bool DrawnNormals::is_given(Index row) const { return row >= 0 && !own_.attribute->values.row(row).isZero(0.0); }

Eigen::RowVector3d DrawnNormals::unit(Index row, Index vertex) const {
  Eigen::RowVector3d normal = Eigen::RowVector3d::Zero();
  if (is_given(row)) {
    normal = own_.attribute->values.row(row);
  } else if (vertex < smooth_.rows()) {
    normal = smooth_.row(vertex);
  }
  const Eigen::RowVector3d unit = normal.stableNormalized();
  return unit.isZero(0.0) ? Eigen::RowVector3d(0.0, 0.0, 1.0) : unit;
}

}  // namespace batten::io
