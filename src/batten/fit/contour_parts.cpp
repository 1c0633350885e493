#include "batten/fit/contour_parts.h"

#include <algorithm>

#include "batten/mesh/summary.h"
#include "batten/mesh/topology.h"

namespace batten {

Points some_samples(const CloudSamples& samples, Index most) {
  const auto size = static_cast<std::int64_t>(samples.points.rows());
  const std::int64_t count = std::min<std::int64_t>(size, most);
  Points some(count, 3);
  for (std::int64_t i = 0; i < count; ++i) some.row(i) = samples.points.row(i * size / count);
  return some;
}

void keep_faces(Mesh& mesh, const Buffer<std::uint8_t>& kept) {
  Buffer<Index> number(static_cast<std::size_t>(mesh.vertex_count()), -1);
  Mesh smaller;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (kept[f] == 0) continue;
    for (Index c = mesh.face_offsets[f]; c < mesh.face_offsets[f + 1]; ++c) number[mesh.face_vertices[c]] = 0;
  }
  Index count = 0;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (number[v] == 0) number[v] = count++;
  }
  smaller.points.resize(count, 3);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (number[v] >= 0) smaller.points.row(number[v]) = mesh.points.row(v);
  }
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (kept[f] == 0) continue;
    for (Index c = mesh.face_offsets[f]; c < mesh.face_offsets[f + 1]; ++c)
      smaller.face_vertices.push_back(number[mesh.face_vertices[c]]);
    smaller.face_offsets.push_back(static_cast<Index>(smaller.face_vertices.size()));
  }
  for (const Crease& crease : mesh.creases) {
    if (number[crease.a] >= 0 && number[crease.b] >= 0)
      smaller.creases.push_back({number[crease.a], number[crease.b], crease.sharpness});
  }
  mesh = std::move(smaller);
}

Index drop_unsupported(Mesh& mesh, const Points& places) {
  const Topology topology(mesh);
  const Components components = connected_components(topology);
  if (components.count < 2) return 0;
  const PointTree tree(mesh.points);
  Buffer<Index> support(static_cast<std::size_t>(components.count), 0);
  for (Eigen::Index row = 0; row < places.rows(); ++row) {
    Index vertex = 0;
    double square = 0.0;
    tree.nearest(places.row(row), 1, &vertex, &square);
    ++support[components.of_vertex[vertex]];
  }
  const auto least = std::max<Index>(4, static_cast<Index>(places.rows() / 100));
  const Index most = *std::max_element(support.begin(), support.end());
  Buffer<std::uint8_t> kept(static_cast<std::size_t>(mesh.face_count()));
  for (Index f = 0; f < mesh.face_count(); ++f)
    kept[f] = support[components.of_vertex[mesh.face_vertices[mesh.face_offsets[f]]]] >= std::min(least, most) ? 1 : 0;
  const auto dropped = static_cast<Index>(
      std::count_if(support.begin(), support.end(), [&](Index s) { return s < std::min(least, most); }));
  if (dropped > 0) keep_faces(mesh, kept);
  return dropped;
}

std::vector<FirstMeshPart> mesh_parts(const Mesh& mesh) {
  std::vector<FirstMeshPart> parts;
  for (const ComponentSummary& component : summarize(Topology(mesh)).components)
    parts.push_back({component.vertices, component.genus(), component.boundary_loops});
  return parts;
}

}  // namespace batten
