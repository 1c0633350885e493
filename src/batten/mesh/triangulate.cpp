#include "batten/mesh/triangulate.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <tuple>
#include <unordered_set>

#include "batten/mesh/face_normal.h"

namespace batten {

namespace {

using Triangle = std::array<Index, 3>;  // positions in the face

/// The pairs of vertices that are already edges. A diagonal between two of them would give that edge too many
/// triangles.
class Edges {
 public:
  void insert(Index a, Index b) { pairs_.insert(key(a, b)); }
  bool contains(Index a, Index b) const { return pairs_.count(key(a, b)) != 0; }

 private:
  static std::uint64_t key(Index a, Index b) {
    constexpr int kBits = 32;
    return (static_cast<std::uint64_t>(std::min(a, b)) << kBits) | static_cast<std::uint32_t>(std::max(a, b));
  }
  std::unordered_set<std::uint64_t> pairs_;
};

Eigen::Vector3d point(const Mesh& mesh, Index corner) {
  return mesh.points.row(mesh.face_vertices[corner]).transpose();
}

/// The ring of corners that have not been cut off from a face.
class EarCutter {
 public:
  EarCutter(const Mesh& mesh, Index face, const Edges& edges)
      : mesh_(mesh), first_(mesh.face_offsets[face]), edges_(edges), normal_(face_normal(mesh, face)) {
    for (Index i = 0; i < mesh.face_size(face); ++i) left_.push_back(i);
  }

  void cut(std::vector<Triangle>& out) {
    while (left_.size() > 3) {
      std::size_t ear = 0;
      while (ear < left_.size() && !(is_ear(ear) && is_free(ear))) ++ear;
      for (std::size_t i = 0; ear == left_.size() && i < left_.size(); ++i) ear = is_ear(i) ? i : ear;
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

  bool is_free(std::size_t i) const {
    return !edges_.contains(mesh_.face_vertices[first_ + before(i)], mesh_.face_vertices[first_ + after(i)]);
  }

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
  const Edges& edges_;
  Eigen::Vector3d normal_;
  std::vector<Index> left_;
};

/// A diagonal of a quad from corner `from`, with the objections to it, the most serious first.
struct Diagonal {
  bool taken;  ///< it is an edge already
  bool folds;  ///< the two triangles would overlap, as with one of the diagonals of an arrowhead
  double square;
  bool better_than(const Diagonal& other) const {
    return std::tuple(taken, folds, square) < std::tuple(other.taken, other.folds, other.square);
  }
};

Diagonal diagonal(const Mesh& mesh, Index first, Index from, const Edges& edges) {
  const auto at = [&](Index i) { return point(mesh, first + (from + i) % 4); };
  const Eigen::Vector3d along = at(2) - at(0);
  const bool folds = (at(1) - at(0)).cross(along).dot(along.cross(at(3) - at(0))) < 0.0;
  const bool taken = edges.contains(mesh.face_vertices[first + from], mesh.face_vertices[first + from + 2]);
  return {taken, folds, along.squaredNorm()};
}

void split_face(const Mesh& mesh, Index face, const Edges& edges, std::vector<Triangle>& out) {
  const Index first = mesh.face_offsets[face];
  const Index size = mesh.face_size(face);
  if (size == 3) {
    out.push_back({0, 1, 2});
  } else if (size == 4) {
    if (diagonal(mesh, first, 1, edges).better_than(diagonal(mesh, first, 0, edges))) {
      out.push_back({0, 1, 3});
      out.push_back({1, 2, 3});
    } else {
      out.push_back({0, 1, 2});
      out.push_back({0, 2, 3});
    }
  } else {
    EarCutter(mesh, face, edges).cut(out);
  }
}

}  // namespace

void triangulate_face(const Mesh& mesh, Index face, std::vector<std::array<Index, 3>>& out) {
  split_face(mesh, face, Edges(), out);
}

Mesh triangulated(const Mesh& mesh) {
  Mesh result = mesh;
  result.face_offsets.assign(1, 0);
  result.face_vertices.clear();
  result.holes.clear();
  for (Attribute& attribute : result.attributes) attribute.corner_rows.clear();
  std::vector<Index> first_triangle(static_cast<std::size_t>(mesh.face_count()) + 1, 0);
  std::vector<Triangle> triangles;
  Edges edges;
  const bool split = !all_triangles(mesh);
  for (Index f = 0; split && f < mesh.face_count(); ++f) {
    const Index first = mesh.face_offsets[f];
    const Index size = mesh.face_size(f);
    for (Index i = 0; i < size; ++i)
      edges.insert(mesh.face_vertices[first + i], mesh.face_vertices[first + (i + 1) % size]);
  }
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Index first = mesh.face_offsets[f];
    triangles.clear();
    split_face(mesh, f, edges, triangles);
    for (const Triangle& triangle : triangles) {
      for (int i = 0; triangles.size() > 1 && i < 3; ++i) {
        edges.insert(mesh.face_vertices[first + triangle[i]], mesh.face_vertices[first + triangle[(i + 1) % 3]]);
      }
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
