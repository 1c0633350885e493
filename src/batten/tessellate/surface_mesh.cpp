#include "batten/tessellate/surface_mesh.h"

#include <utility>

#include "batten/limit/limit_matrix.h"
#include "batten/progress.h"
#include "batten/refine/refined_mesh.h"

namespace batten {

namespace {

/// The normals of the corners' own sides: the vertices' rows, and further ones for corners that differ.
Attribute corner_normals(const Topology& topology, const LimitNormals& normals) {
  Buffer<Index> rows = topology.tables().origins;
  Index extra = 0;
  for (std::size_t h = 0; h < rows.size(); ++h) {
    const auto corner = static_cast<Eigen::Index>(h);
    if (normals.corners.row(corner) != normals.vertices.row(rows[h])) rows[h] = topology.vertex_count() + extra++;
  }
  Values values(normals.vertices.rows() + extra, 3);
  values.topRows(normals.vertices.rows()) = normals.vertices;
  for (std::size_t h = 0; h < rows.size(); ++h) {
    if (rows[h] >= topology.vertex_count()) values.row(rows[h]) = normals.corners.row(static_cast<Eigen::Index>(h));
  }
  return {"normal", std::move(values), std::move(rows)};
}

void drop_holes(const Topology& topology, Mesh& mesh) {
  if (!topology.has_holes()) return;
  Buffer<Index> new_face(static_cast<std::size_t>(mesh.face_count()) + 1);
  Buffer<Index> offsets{0};
  Index kept = 0;
  for (Index f = 0; f < topology.face_count(); ++f) {
    new_face[f] = static_cast<Index>(offsets.size()) - 1;
    if (topology.is_hole(f)) continue;
    for (Index h = topology.face_begin(f); h < topology.face_end(f); ++h, ++kept) {
      mesh.face_vertices[kept] = mesh.face_vertices[h];
      for (Attribute& attribute : mesh.attributes) {
        if (attribute.per_corner()) attribute.corner_rows[kept] = attribute.corner_rows[h];
      }
    }
    offsets.push_back(kept);
  }
  new_face.back() = static_cast<Index>(offsets.size()) - 1;
  mesh.face_vertices.resize(static_cast<std::size_t>(kept));
  for (Attribute& attribute : mesh.attributes) {
    if (attribute.per_corner()) attribute.corner_rows.resize(static_cast<std::size_t>(kept));
  }
  for (Group& group : mesh.groups) group.first_face = new_face[group.first_face];
  mesh.face_offsets = std::move(offsets);
}

}  // namespace

Mesh surface_mesh(const Topology& topology, const Scheme& scheme, const Mesh& control, int levels,
                  const Progress& progress) {
  constexpr double kRefined = 0.5;  // of the time
  constexpr double kBuilt = 0.6;
  constexpr double kMoved = 0.7;
  RefinedMesh refined = refine_mesh(topology, scheme, control, levels, progress_within(progress, 0.0, kRefined));
  const Scheme last = levels > 0 ? scheme.after_first_step() : scheme;
  const LimitMatrix limit(refined.topology, last, {}, progress_within(progress, kRefined, kBuilt));
  Mesh mesh;
  mesh.face_offsets = std::move(refined.mesh.face_offsets);
  mesh.face_vertices = std::move(refined.mesh.face_vertices);
  mesh.groups = std::move(refined.mesh.groups);
  mesh.material_libraries = std::move(refined.mesh.material_libraries);
  mesh.points = limit.apply(refined.mesh.points, progress_within(progress, kBuilt, kMoved));
  for (Attribute& attribute : refined.mesh.attributes) {
    if (!attribute.per_corner()) attribute.values = limit.apply(attribute.values);
    mesh.attributes.push_back(std::move(attribute));
  }
  LimitNormals normals = limit_normals(refined.topology, last, refined.mesh.points, LimitMasks::Exact,
                                       progress_within(progress, kMoved, 1.0));
  Attribute at_corners = corner_normals(refined.topology, normals);
  const bool sides_differ = at_corners.values.rows() > normals.vertices.rows();
  mesh.attributes.push_back({"normal", std::move(normals.vertices), {}});
  if (sides_differ) mesh.attributes.push_back(std::move(at_corners));
  drop_holes(refined.topology, mesh);
  return mesh;
}

}  // namespace batten
