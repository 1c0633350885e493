#include <algorithm>

#include "batten/refine/refinement.h"
#include "batten/tessellate/surface_mesh.h"
#include "shapes.h"

namespace batten::models {
namespace {

constexpr Index kFacesOfALeg = 70;

/// Separates the legs as a scan or an export may do: each leg has its own copy of the vertices along the seams.
Mesh legs_apart(const Mesh& whole, Index faces_of_a_leg) {
  Mesh apart;
  std::vector<Index> copy(static_cast<std::size_t>(whole.vertex_count()), -1);
  std::vector<Index> sources;
  for (Index f = 0; f < whole.face_count(); ++f) {
    if (f % faces_of_a_leg == 0) std::fill(copy.begin(), copy.end(), -1);
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

void reverse_leg(Mesh& mesh, Index leg, Index faces_of_a_leg) {
  for (Index f = leg * faces_of_a_leg; f < (leg + 1) * faces_of_a_leg; ++f)
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
  Mesh mesh = legs_apart(tripod, kFacesOfALeg);
  reverse_leg(mesh, 1, kFacesOfALeg);
  add_fin(mesh, 16, 4);
  const Index* quad = &mesh.face_vertices[mesh.face_offsets[30]];
  mesh.add_face({quad[2], quad[3], quad[0], quad[1]});  // repeats a face
  quad = &mesh.face_vertices[mesh.face_offsets[40]];
  mesh.add_face({quad[0], quad[1], quad[1], quad[0]});  // a face without area
  add_vertex(mesh, {0.0, 0.0, 0.0});                    // a vertex without a face
  return mesh;
}

Mesh tripod_scan(const Mesh& tripod) {
  constexpr int kLevels = 2;
  constexpr Index kFaces = kFacesOfALeg << (2 * kLevels);
  Mesh whole = surface_mesh(Topology(tripod), choose_scheme(tripod), tripod, kLevels);
  add_noise(whole.points, 0.012);
  Mesh scan = legs_apart(whole, kFaces);
  reverse_leg(scan, 1, kFaces);
  const Index* quad = &scan.face_vertices[scan.face_offsets[30]];
  scan.add_face({quad[2], quad[3], quad[0], quad[1]});  // repeats a face
  add_vertex(scan, {0.0, 0.0, 0.0});                    // a vertex without a face
  return scan;
}

}  // namespace batten::models
