#include "batten/patch/reached_faces.h"

#include <algorithm>

#include "batten/mesh/vertex_fans.h"

namespace batten {
namespace {

void sort_once(std::vector<Index>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

std::vector<Index> faces_at(const Topology& topology, std::span<const Index> vertices) {
  std::vector<Index> faces;
  for (const Index vertex : vertices)
    for_each_spoke(topology, vertex, [&](Index half_edge, Index) { faces.push_back(topology.face(half_edge)); });
  sort_once(faces);
  return faces;
}

std::vector<Index> vertices_of(const Topology& topology, std::span<const Index> faces) {
  std::vector<Index> vertices;
  for (const Index face : faces)
    for (Index h = topology.face_begin(face); h < topology.face_end(face); ++h) vertices.push_back(topology.origin(h));
  sort_once(vertices);
  return vertices;
}

}  // namespace

std::vector<Index> reached_faces(const SurfacePatches& patches, std::span<const Index> vertices) {
  const Topology& topology = patches.topology();
  std::vector<Index> faces = faces_at(topology, vertices_of(topology, faces_at(topology, vertices)));
  if (!patches.has_first_step()) return faces;
  std::vector<Index> quads;  // one a corner
  for (const Index face : faces)
    for (Index h = topology.face_begin(face); h < topology.face_end(face); ++h) quads.push_back(h);
  return quads;
}

}  // namespace batten
