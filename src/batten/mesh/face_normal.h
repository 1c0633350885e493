/// \file The normal of a polygon, as long as it is large.
#pragma once
#include <Eigen/Geometry>

#include "batten/mesh/topology.h"

namespace batten {

/// Newell's normal, of a length of twice the area: the sum over the fan from the first corner, whatever the polygon's
/// shape. Relative to that corner, so that faces far from the origin keep their digits. point(i): of type Vector, for
/// the corners 0 to count - 1.
template <typename Vector, typename PointOf>
Vector polygon_normal(Index count, const PointOf& point) {
  Vector sum = Vector::Zero();
  if (count < 3) return sum;
  const Vector origin = point(0);
  Vector before = point(1) - origin;
  for (Index i = 2; i < count; ++i) {
    const Vector here = point(i) - origin;
    sum += before.cross(here);
    before = here;
  }
  return sum;
}

/// Of a face of a mesh that may not be sound, but for this face's corners.
inline Eigen::Vector3d face_normal(const Mesh& mesh, Index face) {
  const Index* corners = mesh.face_vertices.data() + mesh.face_offsets[face];
  return polygon_normal<Eigen::Vector3d>(
      mesh.face_size(face), [&](Index i) -> Eigen::Vector3d { return mesh.points.row(corners[i]).transpose(); });
}

/// points: V-by-3.
inline Eigen::Vector3d face_normal(const Topology& topology, ConstValuesRef points, Index face) {
  const Index first = topology.face_begin(face);
  return polygon_normal<Eigen::Vector3d>(topology.face_size(face), [&](Index i) -> Eigen::Vector3d {
    const double* point = points.data() + topology.origin(first + i) * points.outerStride();
    return {point[0], point[1], point[2]};
  });
}

}  // namespace batten
