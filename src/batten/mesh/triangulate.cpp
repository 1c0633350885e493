#include "batten/mesh/triangulate.h"

#include <Eigen/Geometry>
#include <array>

namespace batten {

namespace {

using Triangle = std::array<Index, 3>;  // positions in the face

Eigen::Vector3d point(const Mesh& mesh, Index corner) {
  return mesh.points.row(mesh.face_vertices[corner]).transpose();
}

/// Newell's normal, not of unit length.
Eigen::Vector3d face_normal(const Mesh& mesh, Index first, Index size) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (Index i = 0; i < size; ++i) normal += point(mesh, first + i).cross(point(mesh, first + (i + 1) % size));
  return normal;
}

/// The ring of corners that are still to be cut from a face.
class EarCutter {
 public:
  EarCutter(const Mesh& mesh, Index first, Index size) : mesh_(mesh), first_(first) {
    normal_ = face_normal(mesh, first, size);
    for (Index i = 0; i < size; ++i) left_.push_back(i);
  }

  void cut(std::vector<Triangle>& out) {
    while (left_.size() > 3) {
      std::size_t ear = 0;
      while (ear < left_.size() && !is_ear(ear)) ++ear;
      if (ear == left_.size()) ear = 1;
      out.push_back({before(ear), left_[ear], after(ear)});
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    out.push_back({left_[0], left_[1], left_[2]});
  }

 private:
  Index before(std::size_t i) const { return left_[(i + left_.size() - 1) % left_.size()]; }
  Index after(std::size_t i) const { return left_[(i + 1) % left_.size()]; }
  Eigen::Vector3d at(Index i) const { return point(mesh_, first_ + i); }
  double turn(Index a, Index b, Index c) const { return (at(b) - at(a)).cross(at(c) - at(b)).dot(normal_); }

  bool is_ear(std::size_t i) const {
    const Index a = before(i);
    const Index b = left_[i];
    const Index c = after(i);
    if (!(turn(a, b, c) > 0.0)) return false;
    for (const Index p : left_) {
      if (p == a || p == b || p == c) continue;
      if (turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0) return false;
    }
    return true;
  }

  const Mesh& mesh_;
  Index first_;
  Eigen::Vector3d normal_;
  std::vector<Index> left_;
};

}  // namespace

void triangulate_face(const Mesh& mesh, Index face, std::vector<std::array<Index, 3>>& out) {
  const Index first = mesh.face_offsets[face];
  const Index size = mesh.face_size(face);
  if (size == 3) {
    out.push_back({0, 1, 2});
  } else if (size == 4) {
    const double across = (point(mesh, first) - point(mesh, first + 2)).squaredNorm();
    const double other = (point(mesh, first + 1) - point(mesh, first + 3)).squaredNorm();
    if (across <= other) {
      out.push_back({0, 1, 2});
      out.push_back({0, 2, 3});
    } else {
      out.push_back({0, 1, 3});
      out.push_back({1, 2, 3});
    }
  } else {
    EarCutter(mesh, first, size).cut(out);
  }
}

Mesh triangulated(const Mesh& mesh) {
  Mesh result = mesh;
  result.face_offsets.assign(1, 0);
  result.face_vertices.clear();
  result.holes.clear();
  for (Attribute& attribute : result.attributes) attribute.corner_rows.clear();
  std::vector<Index> first_triangle(static_cast<std::size_t>(mesh.face_count()) + 1, 0);
  std::vector<Triangle> triangles;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Index first = mesh.face_offsets[f];
    triangles.clear();
    triangulate_face(mesh, f, triangles);
    for (const Triangle& triangle : triangles) {
      for (const Index i : triangle) {
        result.face_vertices.push_back(mesh.face_vertices[first + i]);
        for (std::size_t a = 0; a < mesh.attributes.size(); ++a) {
          if (!mesh.attributes[a].per_corner()) continue;
          result.attributes[a].corner_rows.push_back(mesh.attributes[a].corner_rows[first + i]);
        }
      }
      result.face_offsets.push_back(static_cast<Index>(result.face_vertices.size()));
    }
    first_triangle[f + 1] = result.face_count();
  }
  for (const Index f : mesh.holes) {
    for (Index t = first_triangle[f]; t < first_triangle[f + 1]; ++t) result.holes.push_back(t);
  }
  for (Group& group : result.groups) group.first_face = first_triangle[group.first_face];
  return result;
}

}  // namespace batten
