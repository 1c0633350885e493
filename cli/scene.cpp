/// The scene of a subject: its mesh or the surface of it, its colours, its numbers.
#include <algorithm>
#include <cmath>
#include <limits>

#include "batten/error.h"
#include "batten/expand/surface_fields.h"
#include "batten/mesh/vertex_fields.h"
#include "batten/render/srgb.h"
#include "batten/tessellate/grid_fields.h"
#include "batten/tessellate/surface_mesh.h"
#include "cli/progress.h"
#include "cli/scene.h"

namespace batten::cli {

namespace {

constexpr Color kNeutral{0.42F, 0.42F, 0.41F};  // leaves colours to the numbers

/// True for what the surface has everywhere; valence and sharpness belong to vertices and edges.
bool is_field(Coloring coloring) {
  return coloring == Coloring::Error || coloring == Coloring::Moved || coloring == Coloring::Mean ||
         coloring == Coloring::Gaussian;
}

SurfaceField field_of(Coloring coloring) {
  switch (coloring) {
    case Coloring::Error:
      return SurfaceField::Missed;
    case Coloring::Moved:
      return SurfaceField::Moved;
    case Coloring::Mean:
      return SurfaceField::MeanCurvature;
    default:
      return SurfaceField::GaussianCurvature;
  }
}

ScaleRequest scale_request(Coloring coloring, SchemeKind kind) {
  switch (coloring) {
    case Coloring::Error:
      return {"error", "in the mesh's unit", ColorMap::Sequential, 0.0, true};
    case Coloring::Moved:
      return {"distance moved", "in the mesh's unit", ColorMap::Sequential};
    case Coloring::Mean:
      return mean_curvature_scale();
    case Coloring::Gaussian:
      return {"Gaussian curvature", "1 / unit²", ColorMap::Diverging};
    case Coloring::Valence:
      return {"valence", "", ColorMap::Diverging, kind == SchemeKind::Loop ? 6.0 : 4.0, false, true};
    default:
      break;
  }
  ScaleRequest sharpness{"sharpness", "levels; 10: for ever", ColorMap::Sequential};
  sharpness.outliers = 0.0;  // none is above 10
  return sharpness;
}

/// The scale of the numbers, or that of the range asked for.
ColorScale scale_of(const Eigen::Ref<const Scalars>& numbers, ScaleRequest request, const PictureArguments& arguments) {
  request.range = arguments.range;
  return fit_color_scale(numbers, request);
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

/// Throws Error(BadArgument) where there are none.
const Attribute& texture_coordinates(const Mesh& mesh) {
  const auto found = std::find_if(mesh.attributes.begin(), mesh.attributes.end(), [](const Attribute& attribute) {
    return attribute.name == "uv" && attribute.values.cols() >= 2;
  });
  if (found != mesh.attributes.end()) return *found;
  throw Error(ErrorCode::BadArgument,
              "--color checker shows texture coordinates, but the mesh has none; choose another --color");
}

/// Eight squares a unit of the texture coordinates, by turns light and dark; grey without any. A vertex on a seam has
/// the colour of one side. What lies on the line between two squares belongs to one of them, whatever its rounding.
Values checker_colors(const Mesh& mesh) {
  constexpr double kSquares = 8.0;
  constexpr double kRounding = 1e-6;
  const Attribute& uv = texture_coordinates(mesh);
  Buffer<Index> rows(static_cast<std::size_t>(mesh.vertex_count()), -1);
  for (std::size_t c = 0; c < uv.corner_rows.size(); ++c) rows[mesh.face_vertices[c]] = uv.corner_rows[c];
  Attribute colors{"color", Values::Constant(mesh.vertex_count(), 3, 0.6), {}};
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Index row = uv.per_corner() ? rows[v] : v;
    if (row < 0) continue;
    const auto square_at = [&](Index axis) { return std::floor(kSquares * uv.values(row, axis) + kRounding); };
    const double square = square_at(0) + square_at(1);
    const bool dark = std::fmod(square, 2.0) != 0.0;
    colors.values.row(v) << (dark ? 0.15 : 0.93), (dark ? 0.35 : 0.91), (dark ? 0.6 : 0.86);
  }
  return linear_colors(&colors);
}

Topology topology_of(const Subject& subject, const Progress& progress) {
  return subject.topology ? *subject.topology : Topology(*subject.control, progress);
}

int levels_of(const Subject& subject, const Topology& topology) {
  return subject.levels >= 0 ? subject.levels : picture_levels(topology);
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
  const int levels = levels_of(subject, topology);
  Mesh control;
  control.points = subject.control->points;
  const bool checker = coloring == Coloring::Checker;
  if (checker) control.attributes.push_back(texture_coordinates(*subject.control));
  if (const Attribute* colors = vertex_colors(*subject.control)) control.attributes.push_back(*colors);
  Scene scene;
  scene.surface = surface_mesh(topology, subject.scheme, control, levels, progress);
  scene.colors = checker ? checker_colors(scene.surface) : linear_colors(vertex_colors(scene.surface));
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
  const Mesh& mesh = *subject.control;
  scene.colors = coloring == Coloring::Checker ? checker_colors(mesh) : linear_colors(vertex_colors(mesh));
  if (is_field(coloring)) {
    scene.scalars = vertex_field(field_surface(subject, topology_of(subject, progress)), field_of(coloring));
  }
  return scene;
}

/// Dots at the vertices that are not regular, in the colours of their valence.
void add_valences(const Subject& subject, const Topology& topology, const PictureArguments& arguments, Scene& scene) {
  const Scalars valences = vertex_valences(topology);
  const ScaleRequest request = scale_request(Coloring::Valence, subject.scheme.kind);
  std::vector<Index> irregular;
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (valences[v] > 0.0 && valences[v] != request.middle) irregular.push_back(v);
  }
  scene.markers = scene.surface.points(irregular, Eigen::all);
  scene.marker_scalars = valences(irregular);
  scene.scale = scale_of(valences, request, arguments);
}

/// Lines along the creases of the surface, or of the mesh as it is.
std::vector<CreaseCurve> curves_of(const Subject& subject, const Topology& topology, bool flat) {
  const int levels = flat ? 0 : levels_of(subject, topology);
  if (levels > 0) return crease_curves(topology, Tessellator(topology, subject.scheme, levels));
  std::vector<CreaseCurve> curves;
  for (Index e = 0; e < topology.edge_count(); ++e) {
    const Index h = topology.edge_half_edge(e);
    const double sharpness = crease_sharpness(topology, e);
    if (sharpness > 0.0) curves.push_back({{topology.origin(h), topology.destination(h)}, sharpness});
  }
  return curves;
}

/// Lines along the creases and dots at the sharp vertices, in the colours of their sharpness.
void add_sharpness(const Subject& subject, const Topology& topology, bool flat, const PictureArguments& arguments,
                   Scene& scene) {
  std::vector<double> numbers;
  scene.lines.points = scene.surface.points;
  for (const CreaseCurve& curve : curves_of(subject, topology, flat)) {
    for (std::size_t i = 0; i + 1 < curve.vertices.size(); ++i) {
      scene.lines.add_face({curve.vertices[i], curve.vertices[i + 1]});
      numbers.push_back(curve.sharpness);
    }
  }
  scene.line_scalars = Eigen::Map<const Scalars>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
  std::vector<Index> sharp;
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (topology.vertex_sharpness(v) > 0.0F) sharp.push_back(v);
  }
  scene.markers = scene.surface.points(sharp, Eigen::all);
  scene.marker_scalars.resize(static_cast<Eigen::Index>(sharp.size()));
  for (std::size_t i = 0; i < sharp.size(); ++i) {
    const double sharpness = std::min(double{topology.vertex_sharpness(sharp[i])}, double{kInfiniteSharpness});
    scene.marker_scalars[static_cast<Eigen::Index>(i)] = sharpness;
    numbers.push_back(sharpness);
  }
  const Eigen::Map<const Scalars> all(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
  scene.scale = scale_of(all, scale_request(Coloring::Sharpness, subject.scheme.kind), arguments);
  if (!arguments.range) scene.scale.low = 0.0;
}

/// Adds the edges of a mesh, such as the control mesh, as lines without numbers.
void add_lines(const Mesh& added, Scene& scene) {
  if (added.face_count() == 0) return;
  if (scene.lines.face_count() == 0) {
    scene.lines = bare(added);
    return;
  }
  Mesh& lines = scene.lines;
  const Index first = lines.vertex_count();
  const auto old = static_cast<Eigen::Index>(lines.face_count());
  Points both(first + added.vertex_count(), 3);
  both << lines.points, added.points;
  lines.points = std::move(both);
  const Index corners = lines.face_offsets.back();
  for (const Index v : added.face_vertices) lines.face_vertices.push_back(first + v);
  for (std::size_t f = 1; f < added.face_offsets.size(); ++f)
    lines.face_offsets.push_back(corners + added.face_offsets[f]);
  if (scene.line_scalars.size() == 0) return;
  scene.line_scalars.conservativeResize(lines.face_count());
  scene.line_scalars.tail(lines.face_count() - old).setConstant(std::numeric_limits<double>::quiet_NaN());
}

/// The subject's own numbers and their scale, which is that of the numbers given.
void add_numbers(const Subject& subject, const PictureArguments& arguments, Scene& scene) {
  scene.scale = scale_of(subject.numbers, subject.numbers_scale, arguments);
  if (subject.markers.rows() > 0) {
    scene.marker_scalars = subject.numbers;
    scene.surface_color = kNeutral;
  } else if (scene.surface.vertex_count() == subject.numbers.size()) {
    scene.scalars = subject.numbers;
  } else {
    const Topology topology = topology_of(subject, {});
    scene.scalars = spread_field(field_surface(subject, topology), subject.numbers, levels_of(subject, topology));
  }
}

}  // namespace

Scene scene_of(const Subject& subject, const PictureArguments& arguments, bool quiet) {
  const Coloring coloring = arguments.coloring;
  if (coloring == Coloring::Error && subject.targets == nullptr) {
    throw Error(ErrorCode::BadArgument,
                "--color error needs the points that the surface should pass through: name their mesh by --targets");
  }
  ProgressBar bar("refining", quiet);
  const bool flat = subject.flat || subject.control->face_count() == 0;
  Scene scene = flat ? flat_scene(subject, coloring, bar.callback()) : surface_scene(subject, coloring, bar.callback());
  if (is_field(coloring)) {
    scene.scale = scale_of(scene.scalars, scale_request(coloring, subject.scheme.kind), arguments);
  }
  scene.markers = subject.markers;
  if (coloring == Coloring::Valence || coloring == Coloring::Sharpness) {
    const Topology topology = topology_of(subject, bar.callback());
    scene.surface_color = kNeutral;
    scene.colors.resize(0, 3);
    if (coloring == Coloring::Valence) add_valences(subject, topology, arguments, scene);
    if (coloring == Coloring::Sharpness) add_sharpness(subject, topology, flat, arguments, scene);
  }
  if (subject.numbers.size() > 0) add_numbers(subject, arguments, scene);
  if (subject.draw_control) add_lines(*subject.control, scene);
  add_lines(subject.lines, scene);
  return scene;
}

std::optional<ScaleRequest> surface_scale(const Subject& subject, Coloring coloring) {
  if (subject.numbers.size() > 0) return subject.numbers_scale;
  if (is_field(coloring)) return scale_request(coloring, subject.scheme.kind);
  return std::nullopt;
}

Scene scene_before(const Subject& subject) {
  Scene scene;
  if (subject.before != nullptr) scene.surface = bare(*subject.before);
  return scene;
}

}  // namespace batten::cli
