#include "batten/mesh/vertex_normals.h"

#include <cmath>

#include "batten/mesh/face_normal.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

/// That at corners, where a mesh has both: it tells the sides of creases too.
const Attribute* stated_normal(const Mesh& mesh) {
  const Attribute* found = nullptr;
  for (const Attribute& attribute : mesh.attributes) {
    if (attribute.name != "normal" || attribute.values.cols() != 3) continue;
    if (found == nullptr || attribute.per_corner()) found = &attribute;
  }
  return found;
}

}  // namespace

bool states_normals(const Mesh& mesh) { return stated_normal(mesh) != nullptr; }

Points stated_normals(const Mesh& mesh) {
  const Attribute* attribute = stated_normal(mesh);
  if (attribute != nullptr && !attribute->per_corner()) return attribute->values;
  Points normals = Points::Zero(mesh.vertex_count(), 3);
  if (attribute == nullptr) return normals;
  for (std::size_t c = 0; c < mesh.face_vertices.size(); ++c) {
    const Index row = attribute->corner_rows[c];
    if (row >= 0) normals.row(mesh.face_vertices[c]) += attribute->values.row(row);
  }
  return normals;
}

Points angle_weighted_normals(const Topology& topology, ConstValuesRef points) {
  require_vertex_rows(topology, points);
  Points normals = Points::Zero(topology.vertex_count(), 3);
  Points of_faces(topology.face_count(), 3);
  parallel_for(topology.face_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f)
      of_faces.row(f) = face_normal(topology, points, f).stableNormalized().transpose();
  });
  const auto point = [&](Index vertex) { return Eigen::Vector3d(points.row(vertex).transpose()); };
  const auto normal_at = [&](Index vertex) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    topology.for_each_outgoing(vertex, [&](Index h) {
      const Eigen::Vector3d ahead = point(topology.destination(h)) - point(vertex);
      const Eigen::Vector3d behind = point(topology.origin(topology.previous(h))) - point(vertex);
      const double angle = std::atan2(ahead.cross(behind).norm(), ahead.dot(behind));
      sum += angle * of_faces.row(topology.face(h)).transpose();
    });
    return sum;
  };
  parallel_for(topology.vertex_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      const Eigen::Vector3d sum = normal_at(v);
      const double length = sum.norm();
      if (length > 0.0) normals.row(v) = sum.transpose() / length;
    }
  });
  return normals;
}

}  // namespace batten
