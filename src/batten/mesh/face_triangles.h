/// \file The faces of a topology as triangles that can be found from any corner, and the cotangents of a triangle.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "batten/mesh/topology.h"
#include "batten/mesh/triangulate.h"

namespace batten {

/// The cotangents of a triangle's angles: at its origin and at the ends b and c of the two sides from there.
struct TriangleCotangents {
  double origin;
  double b;
  double c;
  double twice_area;  ///< the cotangents are not finite where this is zero
};

/// to_b, to_c: the two sides from the origin.
inline TriangleCotangents triangle_cotangents(const Eigen::Vector3d& to_b, const Eigen::Vector3d& to_c) {
  const double twice_area = to_b.cross(to_c).norm();
  return {to_b.dot(to_c) / twice_area, to_b.dot(to_b - to_c) / twice_area, to_c.dot(to_c - to_b) / twice_area,
          twice_area};
}

/// The triangles into which triangulate_face splits each face. Where all faces are triangles, nothing is stored.
class FaceTriangles {
 public:
  /// points: V-by-3.
  FaceTriangles(const Topology& topology, ConstValuesRef points) : topology_(topology) {
    if (topology.uniform_face_size() == 3) return;
    Mesh mesh = mesh_from_topology(topology);
    mesh.points = points;
    triangles_.reserve(static_cast<std::size_t>(count()));
    for (Index f = 0; f < topology.face_count(); ++f) triangulate_face(mesh, f, triangles_);
  }

  /// The number of triangles of all faces.
  Index count() const { return topology_.half_edge_count() - 2 * topology_.face_count(); }

  /// The first triangle of face f; the triangles are numbered face by face.
  Index first_of(Index f) const { return topology_.face_begin(f) - 2 * f; }

  /// The vertices of the k-th triangle of face f.
  std::array<Index, 3> vertices(Index f, Index k) const {
    const Index begin = topology_.face_begin(f);
    if (triangles_.empty()) return {topology_.origin(begin), topology_.origin(begin + 1), topology_.origin(begin + 2)};
    const std::array<Index, 3>& places = triangles_[first_of(f) + k];
    return {topology_.origin(begin + places[0]), topology_.origin(begin + places[1]),
            topology_.origin(begin + places[2])};
  }

  /// Calls visit(b, c) for the triangles (origin(h), b, c) at the corner h.
  template <typename Visit>
  void at_corner(Index h, const Visit& visit) const {
    const Index f = topology_.face(h);
    const Index v = topology_.origin(h);
    for (Index k = 0; k + 2 < topology_.face_size(f); ++k) {
      const std::array<Index, 3> triangle = vertices(f, k);
      for (int i = 0; i < 3; ++i) {
        if (triangle[i] == v) visit(triangle[(i + 1) % 3], triangle[(i + 2) % 3]);
      }
    }
  }

 private:
  Topology topology_;
  std::vector<std::array<Index, 3>> triangles_;  ///< as positions in the face
};

}  // namespace batten
