#include "batten/mesh/joined_mesh.h"

namespace batten {

Mesh joined_mesh(std::span<const Mesh> meshes) {
  Mesh result;
  Eigen::Index rows = 0;
  for (const Mesh& mesh : meshes) rows += mesh.points.rows();
  result.points.resize(rows, 3);
  Index vertices = 0;
  for (const Mesh& mesh : meshes) {
    result.points.middleRows(vertices, mesh.points.rows()) = mesh.points;
    const Index faces = result.face_count();
    for (const Crease& crease : mesh.creases)
      result.creases.push_back({crease.a + vertices, crease.b + vertices, crease.sharpness});
    for (const Corner& corner : mesh.corners) result.corners.push_back({corner.vertex + vertices, corner.sharpness});
    for (const Index hole : mesh.holes) result.holes.push_back(hole + faces);
    const auto corners = static_cast<Index>(result.face_vertices.size());
    for (const Index vertex : mesh.face_vertices) result.face_vertices.push_back(vertex + vertices);
    for (Index f = 0; f < mesh.face_count(); ++f) result.face_offsets.push_back(corners + mesh.face_offsets[f + 1]);
    vertices += mesh.vertex_count();
  }
  if (meshes.empty()) return result;
  result.scheme = meshes.front().scheme;
  result.boundary = meshes.front().boundary;
  result.crease_method = meshes.front().crease_method;
  result.triangle_rule = meshes.front().triangle_rule;
  return result;
}

}  // namespace batten
