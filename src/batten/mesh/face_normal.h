/// \file The area normal of a polygon.
#pragma once
#include <Eigen/Geometry>

#include "batten/mesh/topology.h"

namespace batten {

/// Newell's normal, whose length is twice the area: the sum over the fan of triangles from the first corner, for any
/// shape of polygon. Points are taken relative to that corner, so that faces far from the origin lose no digits.
/// point(i) returns corner i as a Vector, for i in [0, count).
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

/// The normal of a face of a mesh in which only this face's corners need be valid.
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
