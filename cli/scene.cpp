/// The scene of a subject: its mesh or the surface of it, its colours, its numbers.
#include <algorithm>

#include "batten/error.h"
#include "batten/expand/surface_fields.h"
#include "batten/render/srgb.h"
#include "batten/tessellate/surface_mesh.h"
#include "cli/progress.h"
#include "cli/scene.h"

namespace batten::cli {

namespace {

bool is_field(Coloring coloring) { return coloring != Coloring::None && coloring != Coloring::Zebra; }

SurfaceField field_of(Coloring coloring) {
  switch (coloring) {
    case Coloring::Error:
      return SurfaceField::Missed;
    case Coloring::Moved:
      return SurfaceField::Moved;
    case Coloring::Mean:
      return SurfaceField::MeanCurvature;
    case Coloring::Gaussian:
      return SurfaceField::GaussianCurvature;
    case Coloring::Valence:
      return SurfaceField::Valence;
    default:
      return SurfaceField::Sharpness;
  }
}

ScaleRequest scale_request(Coloring coloring, SchemeKind kind) {
  switch (coloring) {
    case Coloring::Error:
      return {"error", "in the mesh's unit", ColorMap::Sequential, 0.0, true};
    case Coloring::Moved:
      return {"distance moved", "in the mesh's unit", ColorMap::Sequential, 0.0, false, false, kWildShare};
    case Coloring::Mean:
      return mean_curvature_scale();
    case Coloring::Gaussian:
      return {"Gaussian curvature", "1 / unit²", ColorMap::Diverging, 0.0, false, false, kWildShare};
    case Coloring::Valence:
      return {"valence", "", ColorMap::Diverging, kind == SchemeKind::Loop ? 6.0 : 4.0, false, true};
    default:
      return {"sharpness", "levels; 10: for ever", ColorMap::Warm, 0.0, false, false};
  }
}

/// The part of a mesh that the renderer draws: points, faces and holes.
Mesh bare(const Mesh& mesh) {
  Mesh drawn;
  drawn.points = mesh.points;
  drawn.face_offsets = mesh.face_offsets;
  drawn.face_vertices = mesh.face_vertices;
  drawn.holes = mesh.holes;
  return drawn;
}

/// The mesh's own colours at its vertices, sRGB; null where it has none.
const Attribute* vertex_colors(const Mesh& mesh) {
  for (const Attribute& attribute : mesh.attributes) {
    if (attribute.name == "color" && !attribute.per_corner() && attribute.values.cols() >= 3) return &attribute;
  }
  return nullptr;
}

/// The colours as linear RGB, in which light adds up; none without an attribute.
Values linear_colors(const Attribute* colors) {
  if (colors == nullptr) return Values();
  return colors->values.leftCols(3).unaryExpr([](double value) {
    return static_cast<double>(render_detail::decode_srgb(static_cast<float>(std::clamp(value, 0.0, 1.0))));
  });
}

Topology topology_of(const Subject& subject, const Progress& progress) {
  return subject.topology ? *subject.topology : Topology(*subject.control, progress);
}

FieldSurface field_surface(const Subject& subject, const Topology& topology) {
  return {topology, subject.scheme, subject.control->points, subject.targets};
}

/// The normals at the vertices, or where creases part them at the corners.
Values shading_normals(const Mesh& surface) {
  const Attribute& last = surface.attributes.back();
  if (!last.per_corner()) return last.values;
  return last.values(last.corner_rows, Eigen::all);
}

/// The limit surface with its exact normals and, if asked for, its numbers.
Scene surface_scene(const Subject& subject, Coloring coloring, const Progress& progress) {
  const Topology topology = topology_of(subject, progress);
  const int levels = subject.levels >= 0 ? subject.levels : picture_levels(topology);
  Mesh control;
  control.points = subject.control->points;
  if (const Attribute* colors = vertex_colors(*subject.control)) control.attributes.push_back(*colors);
  Scene scene;
  scene.surface = surface_mesh(topology, subject.scheme, control, levels, progress);
  scene.colors = linear_colors(vertex_colors(scene.surface));
  scene.normals = shading_normals(scene.surface);
  scene.surface.attributes.clear();
  if (is_field(coloring)) scene.scalars = surface_field(field_surface(subject, topology), field_of(coloring), levels);
  return scene;
}

Scene flat_scene(const Subject& subject, Coloring coloring, const Progress& progress) {
  if (coloring == Coloring::Mean || coloring == Coloring::Gaussian) {
    throw Error(ErrorCode::BadArgument,
                "only the surface has a curvature, not the mesh as it is: leave --flat out, or choose another --color");
  }
  Scene scene;
  scene.surface = bare(*subject.control);
  scene.colors = linear_colors(vertex_colors(*subject.control));
  if (is_field(coloring)) {
    scene.scalars = vertex_field(field_surface(subject, topology_of(subject, progress)), field_of(coloring));
  }
  return scene;
}

}  // namespace

Scene scene_of(const Subject& subject, Coloring coloring, bool quiet) {
  if (coloring == Coloring::Error && subject.targets == nullptr) {
    throw Error(ErrorCode::BadArgument,
                "--color error needs the points that the surface should pass through: name their mesh by --targets");
  }
  ProgressBar bar("refining", quiet);
  const bool flat = subject.flat || subject.control->face_count() == 0;
  Scene scene = flat ? flat_scene(subject, coloring, bar.callback()) : surface_scene(subject, coloring, bar.callback());
  if (is_field(coloring)) {
    scene.scale = fit_color_scale(scene.scalars, scale_request(coloring, subject.scheme.kind));
    if (coloring == Coloring::Sharpness) scene.scale.low = 0.0;
  }
  scene.markers = subject.markers;
  if (subject.numbers.size() > 0) {
    const bool at_markers = subject.markers.rows() > 0;
    (at_markers ? scene.marker_scalars : scene.scalars) = subject.numbers;
    scene.scale = fit_color_scale(subject.numbers, subject.numbers_scale);
    if (at_markers) scene.surface_color = {0.42F, 0.42F, 0.41F};  // leaves colours to the numbers
  }
  if (subject.draw_control) scene.lines = bare(*subject.control);
  return scene;
}

Scene scene_before(const Subject& subject) {
  Scene scene;
  if (subject.before != nullptr) scene.surface = bare(*subject.before);
  return scene;
}

}  // namespace batten::cli
