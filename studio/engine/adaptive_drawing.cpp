#include "studio/engine/adaptive_drawing.h"

#include <algorithm>
#include <limits>

#include "batten/adaptive/adaptive_surface_mesh.h"
#include "batten/mesh/vertex_fields.h"
#include "batten/surface/limit_surface.h"

namespace batten::studio {
namespace {

constexpr Index kMostFaces = 2'000'000;  // what a browser draws

AdaptiveOptions options_of(double chord) {
  AdaptiveOptions options;
  options.chord = chord;
  options.max_faces = kMostFaces;
  return options;
}

const Attribute& attribute_of(const AdaptiveMesh& adaptive, const std::string& name) {
  const auto& attributes = adaptive.mesh.attributes;
  return *std::find_if(attributes.begin(), attributes.end(), [&](const Attribute& one) { return one.name == name; });
}

/// The row of an attribute at each corner.
const Buffer<Index>& rows_of(const AdaptiveMesh& adaptive, const Attribute& attribute) {
  return attribute.per_corner() ? attribute.corner_rows : adaptive.mesh.face_vertices;
}

/// Numbers at the control mesh's vertices, linearly over its faces.
Scalars spread_adaptively(const FieldSurface& surface, const Scalars& numbers, const AdaptiveDrawing& drawing,
                          double chord) {
  Mesh control = mesh_from_topology(surface.topology);
  control.points = surface.control;
  control.attributes.push_back({"number", numbers, surface.topology.tables().origins});
  Scheme scheme = surface.scheme;
  scheme.face_varying = FaceVaryingRule::All;
  const AdaptiveMesh fine = adaptive_surface_mesh(surface.topology, scheme, control, options_of(chord));
  const Attribute& number = attribute_of(fine, "number");
  const Buffer<Index>& rows = rows_of(fine, number);
  Scalars spread =
      Scalars::Constant(static_cast<Eigen::Index>(drawing.points.size() / 3), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t c = 0; c < rows.size(); ++c) spread[drawing.triangles[c]] = number.values(rows[c], 0);
  return spread;
}

}  // namespace

AdaptiveDrawing draw_adaptively(const SurfacePatches& patches, const Values& control, double chord) {
  AdaptiveDrawing drawing;
  drawing.adaptive = tessellate_adaptively(patches, control, options_of(chord));
  const Mesh& mesh = drawing.adaptive.mesh;
  const Attribute& normal = attribute_of(drawing.adaptive, "normal");
  const Buffer<Index>& rows = rows_of(drawing.adaptive, normal);
  drawing.triangles.assign(rows.begin(), rows.end());
  drawing.points.resize(3 * static_cast<std::size_t>(normal.values.rows()));
  drawing.normals.resize(drawing.points.size());
  const auto put = [](const auto& row, std::vector<float>& numbers, Index at) {
    for (Index axis = 0; axis < 3; ++axis)
      numbers[3 * static_cast<std::size_t>(at) + static_cast<std::size_t>(axis)] = static_cast<float>(row[axis]);
  };
  for (Index v = 0; v < mesh.vertex_count(); ++v) put(mesh.points.row(v), drawing.points, v);
  for (std::size_t c = 0; c < rows.size(); ++c) put(mesh.points.row(mesh.face_vertices[c]), drawing.points, rows[c]);
  for (Index row = 0; row < normal.values.rows(); ++row) put(normal.values.row(row), drawing.normals, row);
  return drawing;
}

Scalars adaptive_field(const FieldSurface& surface, SurfaceField field, const AdaptiveDrawing& drawing, double chord) {
  if (!is_curvature(field)) return spread_adaptively(surface, vertex_field(surface, field), drawing, chord);
  const LimitSurface limit(surface.topology, surface.scheme, surface.control);
  const AdaptiveMesh& adaptive = drawing.adaptive;
  Scalars numbers(adaptive.mesh.vertex_count());
  for (Index v = 0; v < numbers.size(); ++v) {
    const PointCurvature curvature = curvature_of(limit.jet(adaptive.places[static_cast<std::size_t>(v)]));
    numbers[v] = field == SurfaceField::MeanCurvature ? curvature.mean : curvature.gaussian;
  }
  fill_from_neighbours(3, adaptive.mesh.face_vertices, numbers);
  Scalars drawn(static_cast<Eigen::Index>(drawing.points.size() / 3));
  drawn.head(numbers.size()) = numbers;
  for (std::size_t c = 0; c < drawing.triangles.size(); ++c)
    drawn[drawing.triangles[c]] = numbers[adaptive.mesh.face_vertices[c]];
  return drawn;
}

}  // namespace batten::studio
