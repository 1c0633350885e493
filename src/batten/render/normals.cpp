#include <algorithm>
#include <array>
#include <cmath>

#include "batten/mesh/face_normal.h"
#include "batten/parallel/parallel.h"
#include "batten/render/geometry.h"

namespace batten::render_detail {
namespace {

// Faces that meet at less than 34 degrees share their normals; those that meet at more than 48 degrees share nothing.
// In between they share a part, because scans have many edges near 40 degrees, along which a sharp limit would draw a
// zigzag.
constexpr float kSharedCosine = 0.8290376F;
constexpr float kSplitCosine = 0.6691306F;
constexpr float kHalfSharedCosine = 0.9563048F;  // of 17 degrees: two faces within it of a third meet at less than 34
constexpr int kMostSteps = 32;

float shared(float cosine) {
  const float t = std::clamp((cosine - kSplitCosine) / (kSharedCosine - kSplitCosine), 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

Vec unit(const Vec& v) {
  const float length = v.norm();
  return length > 0.0F ? Vec(v / length) : Vec(Vec::Zero());
}

Vec face_normal(const Mesh& mesh, const Buffer<Vec>& points, Index face) {
  const Index* v = mesh.face_vertices.data() + mesh.face_offsets[face];
  return unit(polygon_normal<Vec>(mesh.face_size(face), [&](Index i) { return points[v[i]]; }));
}

/// The corners of each vertex: vertex v has corners[offsets[v]] to corners[offsets[v + 1]].
struct Incidence {
  Buffer<Index> offsets;
  Buffer<Index> corners;
  Buffer<Index> corner_faces;
};

Incidence incidence_of(const Mesh& mesh) {
  const auto vertices = static_cast<std::size_t>(mesh.vertex_count());
  Incidence incidence;
  incidence.offsets.assign(vertices + 1, 0);
  incidence.corners.resize(mesh.face_vertices.size());
  incidence.corner_faces.resize(mesh.face_vertices.size());
  for (const Index vertex : mesh.face_vertices) ++incidence.offsets[static_cast<std::size_t>(vertex)];
  Index end = 0;
  for (Index& offset : incidence.offsets) {
    end += offset;
    offset = end;
  }
  // Filling backwards keeps each vertex's corners in the mesh's order and leaves its offset at their beginning.
  for (Index f = mesh.face_count() - 1; f >= 0; --f) {
    for (Index c = mesh.face_offsets[f + 1] - 1; c >= mesh.face_offsets[f]; --c) {
      incidence.corners[--incidence.offsets[mesh.face_vertices[c]]] = c;
      incidence.corner_faces[c] = f;
    }
  }
  return incidence;
}

/// Processes one vertex: gathers its corners' weighted face normals by runs of faces that meet smoothly.
class VertexFan {
 public:
  VertexFan(const Mesh& mesh, const Incidence& incidence, const Buffer<Vec>& points, const Buffer<Vec>& face_normals)
      : mesh_(mesh), incidence_(incidence), points_(points), face_normals_(face_normals) {}

  /// Stores the vertex's normal in normals[vertex]. If its faces do not all meet smoothly, also stores each corner's in
  /// normals[vertex_count + corner] and returns true.
  bool process(Index vertex, Buffer<Vec>& normals) {
    begin_ = incidence_.offsets[vertex];
    size_ = incidence_.offsets[vertex + 1] - begin_;
    weights_.resize(static_cast<std::size_t>(size_));
    Vec sum = Vec::Zero();
    for (Index i = 0; i < size_; ++i) {
      weights_[i] = angle(vertex, corner(i));
      sum += weights_[i] * normal(i);
    }
    const Vec mean = unit(sum);
    normals[vertex] = mean;
    bool smooth = true;
    for (Index i = 0; i < size_; ++i) smooth = smooth && mean.dot(normal(i)) > kHalfSharedCosine;
    if (smooth) return false;
    if (!find_neighbours()) return false;
    shares_.assign(static_cast<std::size_t>(size_), 0.0F);
    for (Index i = 0; i < size_; ++i) normals[mesh_.vertex_count() + corner(i)] = corner_normal(i);
    return true;
  }

 private:
  Index corner(Index i) const { return incidence_.corners[begin_ + i]; }
  const Vec& normal(Index i) const { return face_normals_[incidence_.corner_faces[corner(i)]]; }

  Index neighbour(Index at, Index step) const {
    const Index face = incidence_.corner_faces[at];
    const Index first = mesh_.face_offsets[face];
    const Index size = mesh_.face_size(face);
    return mesh_.face_vertices[first + (at - first + step + size) % size];
  }

  float angle(Index vertex, Index at) const {
    const Vec a = points_[neighbour(at, 1)] - points_[vertex];
    const Vec b = points_[neighbour(at, -1)] - points_[vertex];
    return std::atan2(a.cross(b).norm(), a.dot(b));
  }

  struct Link {
    Index other = -1;
    float shared = 0.0F;
  };

  /// Fills links_, the corners beyond each corner's two edges. After sorting the edges, corners that share one are
  /// adjacent. Returns false if every link shares everything.
  bool find_neighbours() {
    links_.assign(static_cast<std::size_t>(size_), {});
    edges_.clear();
    for (Index i = 0; i < size_; ++i) {
      edges_.emplace_back(neighbour(corner(i), 1), 2 * i);
      edges_.emplace_back(neighbour(corner(i), -1), 2 * i + 1);
    }
    std::sort(edges_.begin(), edges_.end());
    bool any_split = false;
    for (std::size_t e = 0; e + 1 < edges_.size(); ++e) {
      if (edges_[e].first != edges_[e + 1].first) continue;
      const Index a = edges_[e].second;
      const Index b = edges_[e + 1].second;
      const float part = shared(normal(a / 2).dot(normal(b / 2)));
      links_[a / 2][a % 2] = {b / 2, part};
      links_[b / 2][b % 2] = {a / 2, part};
      any_split = any_split || part < 1.0F;
    }
    return any_split;
  }

  /// The sum of the surrounding normals, each weighted by the product of what the edges up to it share, in the better
  /// of the two directions.
  Vec corner_normal(Index i) {
    reached_.assign(1, i);
    shares_[i] = 1.0F;
    walk(i, 0);
    walk(i, 1);
    Vec sum = Vec::Zero();
    for (const Index j : reached_) {
      sum += shares_[j] * weights_[j] * normal(j);
      shares_[j] = 0.0F;
    }
    return unit(sum);
  }

  void walk(Index i, std::size_t side) {
    float part = 1.0F;
    for (int step = 0; step < kMostSteps; ++step) {
      const Link& link = links_[i][side];
      part *= link.shared;
      if (link.other < 0 || part < 1e-3F) return;
      i = link.other;
      if (shares_[i] == 0.0F) reached_.push_back(i);
      shares_[i] = std::max(shares_[i], part);
    }
  }

  const Mesh& mesh_;
  const Incidence& incidence_;
  const Buffer<Vec>& points_;
  const Buffer<Vec>& face_normals_;
  Index begin_ = 0;
  Index size_ = 0;
  std::vector<float> weights_;
  std::vector<std::array<Link, 2>> links_;
  std::vector<float> shares_;
  std::vector<Index> reached_;
  std::vector<std::pair<Index, Index>> edges_;
};

}  // namespace

void compute_normals(const Mesh& mesh, const Buffer<std::uint32_t>& triangle_corners, Triangles& triangles) {
  Buffer<Vec> face_normals(static_cast<std::size_t>(mesh.face_count()));
  parallel_for(mesh.face_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f)
      face_normals[f] = mesh.face_size(f) >= 3 ? face_normal(mesh, triangles.points, f) : Vec(Vec::Zero());
  });
  const Incidence incidence = incidence_of(mesh);
  const auto vertices = static_cast<std::size_t>(mesh.vertex_count());
  triangles.normals.resize(vertices + mesh.face_vertices.size());
  Buffer<std::uint8_t> split(vertices);
  const bool all_whole = parallel_all_of(mesh.vertex_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    VertexFan fan(mesh, incidence, triangles.points, face_normals);
    bool whole = true;
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      split[v] = fan.process(v, triangles.normals) ? 1 : 0;
      whole &= split[v] == 0;
    }
    return whole;
  });
  if (all_whole) return;
  triangles.normal_rows.resize(triangle_corners.size());
  parallel_for(static_cast<std::ptrdiff_t>(triangle_corners.size()), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t c = begin; c < end; ++c) {
      const std::uint32_t vertex = triangles.vertices[c];
      triangles.normal_rows[c] =
          split[vertex] != 0 ? static_cast<std::uint32_t>(vertices) + triangle_corners[c] : vertex;
    }
  });
}

}  // namespace batten::render_detail
