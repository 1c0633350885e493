#include <algorithm>

#include "shapes.h"

namespace batten::models {
namespace {

constexpr Index kFacesOfALeg = 70;

/// Separates the legs as a scan or an export may do: each leg has its own copy of the vertices along the seams.
Mesh legs_apart(const Mesh& whole) {
  Mesh apart;
  std::vector<Index> copy(static_cast<std::size_t>(whole.vertex_count()), -1);
  std::vector<Index> sources;
  for (Index f = 0; f < whole.face_count(); ++f) {
    if (f % kFacesOfALeg == 0) std::fill(copy.begin(), copy.end(), -1);
    for (Index c = whole.face_offsets[f]; c < whole.face_offsets[f + 1]; ++c) {
      Index& vertex = copy[static_cast<std::size_t>(whole.face_vertices[c])];
      if (vertex < 0) {
        vertex = static_cast<Index>(sources.size());
        sources.push_back(whole.face_vertices[c]);
      }
      apart.face_vertices.push_back(vertex);
    }
    apart.face_offsets.push_back(static_cast<Index>(apart.face_vertices.size()));
  }
  apart.points.resize(static_cast<Eigen::Index>(sources.size()), 3);
  for (std::size_t v = 0; v < sources.size(); ++v)
    apart.points.row(static_cast<Eigen::Index>(v)) = whole.points.row(sources[v]);
  return apart;
}

void reverse_leg(Mesh& mesh, Index leg) {
  for (Index f = leg * kFacesOfALeg; f < (leg + 1) * kFacesOfALeg; ++f)
    std::reverse(mesh.face_vertices.begin() + mesh.face_offsets[f],
                 mesh.face_vertices.begin() + mesh.face_offsets[f + 1]);
}

Index add_vertex(Mesh& mesh, const Eigen::RowVector3d& point) {
  mesh.points.conservativeResize(mesh.points.rows() + 1, 3);
  mesh.points.bottomRows(1) = point;
  return mesh.vertex_count() - 1;
}

/// Adds a row of quads on the sides from corner 0 to corner 1 of faces `first`, `first` + 8, ..., which are on a leg.
void add_fin(Mesh& mesh, Index first, Index count) {
  const Eigen::RowVector3d up(0.0, 0.0, 0.35);
  Index before = -1;
  for (Index i = 0; i < count; ++i) {
    const Index corner = mesh.face_offsets[first + 8 * i];
    const Index a = mesh.face_vertices[corner];
    const Index b = mesh.face_vertices[corner + 1];
    if (before < 0) before = add_vertex(mesh, mesh.points.row(a) + up);
    const Index after = add_vertex(mesh, mesh.points.row(b) + up);
    mesh.add_face({a, b, after, before});
    before = after;
  }
}

}  // namespace

Mesh broken_tripod(const Mesh& tripod) {
  Mesh mesh = legs_apart(tripod);
  reverse_leg(mesh, 1);
  add_fin(mesh, 16, 4);
  const Index* quad = &mesh.face_vertices[mesh.face_offsets[30]];
  mesh.add_face({quad[2], quad[3], quad[0], quad[1]});  // repeats a face
  quad = &mesh.face_vertices[mesh.face_offsets[40]];
  mesh.add_face({quad[0], quad[1], quad[1], quad[0]});  // a face without area
  add_vertex(mesh, {0.0, 0.0, 0.0});                    // a vertex without a face
  return mesh;
}

}  // namespace batten::models
