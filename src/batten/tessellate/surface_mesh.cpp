#include "batten/tessellate/surface_mesh.h"

#include <algorithm>
#include <string>
#include <utility>

#include "batten/error.h"
#include "batten/limit/limit_matrix.h"
#include "batten/mesh/checked_values.h"
#include "batten/progress.h"
#include "batten/refine/refinement.h"
#include "batten/tessellate/butterfly_grids.h"
#include "batten/tessellate/face_varying_limit.h"
#include "batten/tessellate/side_normals.h"
#include "batten/tessellate/tessellator.h"

namespace batten {

namespace {

std::span<double> numbers_of(Values& values) { return {values.data(), static_cast<std::size_t>(values.size())}; }
std::span<double> numbers_of(Points& points) { return {points.data(), static_cast<std::size_t>(points.size())}; }

Buffer<Index> offsets_of(std::size_t face_count, Index face_size) {
  Buffer<Index> offsets(face_count + 1);
  for (std::size_t f = 0; f <= face_count; ++f) offsets[f] = static_cast<Index>(f) * face_size;
  return offsets;
}

/// Rows for the corners whose normal differs from that of their vertex; without corner rows where none does.
Attribute corner_normals(const Buffer<Index>& face_vertices, const Values& at_vertices, const Values& at_corners) {
  Buffer<Index> rows = face_vertices;
  Buffer<Eigen::Index> differing;
  for (std::size_t c = 0; c < rows.size(); ++c) {
    const auto corner = static_cast<Eigen::Index>(c);
    if (at_corners.row(corner) == at_vertices.row(rows[c])) continue;
    rows[c] = static_cast<Index>(at_vertices.rows() + static_cast<Eigen::Index>(differing.size()));
    differing.push_back(corner);
  }
  if (differing.empty()) return {"normal", Values(), {}};
  Values values(at_vertices.rows() + static_cast<Eigen::Index>(differing.size()), 3);
  values.topRows(at_vertices.rows()) = at_vertices;
  values.bottomRows(static_cast<Eigen::Index>(differing.size())) = at_corners(differing, Eigen::all);
  return {"normal", std::move(values), std::move(rows)};
}

/// Control points have no normals of the surface, and a mesh without faces has no corners.
bool is_left_out(const Attribute& attribute, const Mesh& mesh) {
  return attribute.name == "normal" || (attribute.per_corner() && mesh.face_vertices.empty());
}

void append_normals(Values at_vertices, Attribute at_corners, Mesh& mesh) {
  mesh.attributes.push_back({"normal", std::move(at_vertices), {}});
  if (at_corners.per_corner()) mesh.attributes.push_back(std::move(at_corners));
}

/// The control mesh's own faces between its limit positions.
Mesh limit_mesh(const Topology& topology, const Scheme& scheme, const Mesh& control, const Progress& progress) {
  constexpr double kBuilt = 0.3;  // of the time
  constexpr double kMoved = 0.5;
  const Topology shown = with_surface_holes(topology, scheme);
  const LimitMatrix limit(topology, scheme, {}, progress_within(progress, 0.0, kBuilt));
  Mesh mesh;
  Buffer<Index> drawn;  // half-edges of faces that are no holes
  Buffer<Index> new_face;
  for (Index f = 0; f < topology.face_count(); ++f) {
    new_face.push_back(mesh.face_count());
    if (shown.is_hole(f)) continue;
    for (Index h = topology.face_begin(f); h < topology.face_end(f); ++h) {
      drawn.push_back(h);
      mesh.face_vertices.push_back(topology.origin(h));
    }
    mesh.face_offsets.push_back(static_cast<Index>(drawn.size()));
  }
  new_face.push_back(mesh.face_count());
  for (const Group& group : control.groups) {
    mesh.groups.push_back({group.keyword, group.name, new_face[group.first_face]});
  }
  mesh.points = limit.apply(control.points, progress_within(progress, kBuilt, kMoved));
  for (const Attribute& attribute : control.attributes) {
    if (is_left_out(attribute, mesh)) continue;
    if (!attribute.per_corner()) {
      require_finite(attribute.values, ("attribute '" + attribute.name + "'").c_str());
      const bool moves = attribute.carry == CarryRule::Scheme;
      mesh.attributes.push_back({attribute.name, moves ? limit.apply(attribute.values) : attribute.values, {}});
      continue;
    }
    if (!scheme.has_linear_corners()) {
      mesh.attributes.push_back(face_varying_limit(shown, scheme, attribute, 0));
      continue;
    }
    if (attribute.corner_rows.size() != static_cast<std::size_t>(topology.half_edge_count())) {
      throw Error(ErrorCode::BadShape, "attribute '" + attribute.name + "' must have one row number per corner");
    }
    mesh.attributes.push_back({attribute.name, attribute.values, {}});
    for (const Index h : drawn) mesh.attributes.back().corner_rows.push_back(attribute.corner_rows[h]);
  }
  LimitNormals normals =
      limit_normals(topology, scheme, control.points, LimitMasks::Exact, progress_within(progress, kMoved, 1.0));
  Attribute at_corners = corner_normals(mesh.face_vertices, normals.vertices, normals.corners(drawn, Eigen::all));
  append_normals(std::move(normals.vertices), std::move(at_corners), mesh);
  return mesh;
}

/// Where the faces of a tessellation stand among those of the control mesh.
struct DrawnFaces {
  Buffer<Index> of_control;  ///< drawn base faces before each control face, and their number
  Buffer<Index> face_rank;   ///< of each base face; -1: not drawn
};

DrawnFaces drawn_faces(const SurfacePatches& patches) {
  const auto control_faces = static_cast<std::size_t>(patches.topology().face_count());
  const Buffer<std::uint8_t>& holes = patches.holes();
  DrawnFaces faces;
  Index drawn = 0;
  for (Index f = 0; f < patches.base().face_count(); ++f) {
    faces.of_control.resize(static_cast<std::size_t>(patches.control_face(f)) + 1, drawn);
    faces.face_rank.push_back(!holes.empty() && holes[f] != 0 ? -1 : drawn++);
  }
  faces.of_control.resize(control_faces + 1, drawn);
  return faces;
}

/// Rows for the corners of the faces that are drawn, from those of all.
Values corners_drawn(const Buffer<Index>& face_rank, Eigen::Index per_face, const Values& corners) {
  Values drawn(corners.rows(), 3);
  Eigen::Index count = 0;
  for (std::size_t f = 0; f < face_rank.size(); ++f) {
    if (face_rank[f] < 0) continue;
    drawn.middleRows(per_face * count++, per_face) =
        corners.middleRows(per_face * static_cast<Eigen::Index>(f), per_face);
  }
  return drawn.topRows(per_face * count);
}

/// An attribute of the control mesh on the tessellation.
Attribute carried(const SurfacePatches& patches, const Tessellator& tessellator, const Attribute& attribute, int levels,
                  const Progress& progress) {
  const Scheme& scheme = patches.scheme();
  if (attribute.per_corner()) {
    if (scheme.has_linear_corners()) return tessellator.at_corners(attribute);
    return face_varying_limit(with_surface_holes(patches.topology(), scheme), scheme, attribute, levels, progress);
  }
  require_finite(attribute.values, ("attribute '" + attribute.name + "'").c_str());
  if (attribute.carry == CarryRule::Midpoint) {
    return {attribute.name, tessellator.midpoints(attribute.values, progress), {}};
  }
  Attribute result{attribute.name, Values(tessellator.vertex_count(), attribute.values.cols()), {}};
  tessellator.limit<double>(attribute.values, numbers_of(result.values), {}, progress);
  return result;
}

void fill_points(const SurfacePatches& patches, const Mesh& control, const Tessellator& tessellator,
                 const DrawnFaces& faces, int levels, Mesh& mesh, const Progress& progress) {
  constexpr double kFilled = 0.5;  // of the time
  mesh.points.resize(tessellator.vertex_count(), 3);
  if (is_interpolating(patches.scheme().kind)) {
    tessellator.limit<double>(control.points, numbers_of(mesh.points), {}, progress_within(progress, 0.0, kFilled));
    LimitNormals normals = butterfly_grid_normals(patches.base(), patches.scheme(), mesh.points, levels);
    const Eigen::Index per_face = Eigen::Index{3} * tessellator.steps() * tessellator.steps();
    const Values at_corners = corners_drawn(faces.face_rank, per_face, normals.corners);
    Attribute differing = corner_normals(mesh.face_vertices, normals.vertices, at_corners);
    return append_normals(std::move(normals.vertices), std::move(differing), mesh);
  }
  Values normals(tessellator.vertex_count(), 3);
  tessellator.limit<double>(control.points, numbers_of(mesh.points), numbers_of(normals),
                            progress_within(progress, 0.0, kFilled));
  Attribute differing =
      side_normals({patches, control.points, tessellator, faces.face_rank, mesh.face_vertices, normals});
  append_normals(std::move(normals), std::move(differing), mesh);
}

}  // namespace

Mesh surface_mesh(const Topology& topology, const Scheme& scheme, const Mesh& control, int levels,
                  const Progress& progress) {
  if (levels < 0) throw Error(ErrorCode::BadArgument, "levels must not be negative");
  require_vertex_rows(topology, control.points);
  if (levels == 0) {
    Mesh mesh = limit_mesh(topology, scheme, control, progress);
    mesh.material_libraries = control.material_libraries;
    return mesh;
  }
  constexpr double kBuilt = 0.1;  // of the time
  constexpr double kFaces = 0.2;
  const SurfacePatches patches(topology, scheme, progress_within(progress, 0.0, kBuilt));
  const Tessellator tessellator(patches, levels);
  const DrawnFaces faces = drawn_faces(patches);
  Mesh mesh;
  mesh.material_libraries = control.material_libraries;
  mesh.face_offsets = offsets_of(static_cast<std::size_t>(tessellator.face_count()), tessellator.face_size());
  mesh.face_vertices.resize(static_cast<std::size_t>(tessellator.face_count()) *
                            static_cast<std::size_t>(tessellator.face_size()));
  tessellator.faces(mesh.face_vertices);
  const Index per_face = tessellator.steps() * tessellator.steps();
  for (const Group& group : control.groups) {
    mesh.groups.push_back({group.keyword, group.name, faces.of_control[group.first_face] * per_face});
  }
  report_progress(progress, kFaces);
  const double share = (1.0 - kFaces) / static_cast<double>(control.attributes.size() + 1);
  double done = kFaces;
  for (const Attribute& attribute : control.attributes) {
    if (is_left_out(attribute, mesh)) continue;
    mesh.attributes.push_back(
        carried(patches, tessellator, attribute, levels, progress_within(progress, done, done + share)));
    done += share;
    report_progress(progress, done);
  }
  fill_points(patches, control, tessellator, faces, levels, mesh, progress_within(progress, done, 1.0));
  report_progress(progress, 1.0);
  return mesh;
}

int levels_within(const Topology& topology, double faces, int most) {
  int levels = 0;
  for (double next = 4.0 * topology.face_count(); levels < most && next <= faces; next *= 4.0) ++levels;
  return levels;
}

int picture_levels(const Topology& topology) {
  constexpr double kFaces = 4e5;
  constexpr int kMost = 5;
  return levels_within(topology, kFaces, kMost);
}

}  // namespace batten
