#include "cli/picture.h"

#include <algorithm>

#include "batten/error.h"
#include "batten/limit/limit_matrix.h"
#include "batten/refine/refinement.h"
#include "batten/surface/curvature.h"
#include "cli/common.h"
#include "cli/vertex_fields.h"
#ifdef BATTEN_WITH_RENDER
#include "batten/render/panels.h"
#include "batten/render/srgb.h"
#endif

namespace batten::cli {

int picture_levels(const Topology& topology) {
  constexpr double kFaces = 4e5;
  double faces = std::max<Index>(topology.face_count(), 1);
  int levels = 0;
  while (levels < 5 && faces * 4.0 <= kFaces) {
    faces *= 4.0;
    ++levels;
  }
  return levels;
}

// Curvature has no bound at extraordinary points: a few numbers must not take the whole bar.
static constexpr double kWild = 0.02;

ScaleRequest mean_curvature_scale() {
  return {"mean curvature", "1 / unit", ColorMap::Diverging, 0.0, false, false, kWild};
}

#ifdef BATTEN_WITH_RENDER

namespace {

bool is_scalar(Coloring coloring) { return coloring != Coloring::None && coloring != Coloring::Zebra; }

ScaleRequest scale_request(Coloring coloring, SchemeKind kind) {
  switch (coloring) {
    case Coloring::Error:
      return {"error", "in the mesh's unit", ColorMap::Sequential, 0.0, true};
    case Coloring::Moved:
      return {"distance moved", "in the mesh's unit", ColorMap::Sequential, 0.0, false, false, kWild};
    case Coloring::Mean:
      return mean_curvature_scale();
    case Coloring::Gaussian:
      return {"Gaussian curvature", "1 / unit²", ColorMap::Diverging, 0.0, false, false, kWild};
    case Coloring::Valence:
      return {"valence", "", ColorMap::Diverging, kind == SchemeKind::Loop ? 6.0 : 4.0, false, true};
    default:
      return {"sharpness", "levels; 10: for ever", ColorMap::Warm, 0.0, false, false};
  }
}

/// The numbers at the control mesh's vertices.
Scalars vertex_field(const Subject& subject, const Topology& topology, Coloring coloring) {
  if (coloring == Coloring::Valence) return valences(topology);
  if (coloring == Coloring::Sharpness) return sharpnesses(topology);
  const Values limit = LimitMatrix(topology, subject.scheme).apply(subject.control.points);
  if (coloring == Coloring::Moved) return (limit - subject.control.points).rowwise().norm();
  if (!subject.targets) {
    throw Error(ErrorCode::BadArgument,
                "--color error needs the points that the surface should pass through: name their mesh by --targets");
  }
  if (subject.targets->rows() > limit.rows()) {
    throw Error(ErrorCode::BadShape, "there are more targets (" + std::to_string(subject.targets->rows()) +
                                         ") than vertices (" + std::to_string(limit.rows()) + ")");
  }
  // A mesh that was refined once for alpha has more vertices than targets; those have no error of their own.
  const Values missed = limit.topRows(subject.targets->rows()) - *subject.targets;
  Scalars errors = Scalars::Zero(limit.rows());
  errors.head(missed.rows()) = missed.rowwise().norm();
  return errors;
}

/// The mesh's own colours at its vertices, sRGB; empty where it has none.
Values vertex_colors(const Mesh& mesh) {
  for (const Attribute& attribute : mesh.attributes) {
    if (attribute.name == "color" && !attribute.per_corner() && attribute.values.cols() >= 3)
      return attribute.values.leftCols(3);
  }
  return Values();
}

/// As the light needs them.
Values linear_colors(const Values& colors) {
  return colors.unaryExpr([](double value) {
    return static_cast<double>(render_detail::decode_srgb(static_cast<float>(std::clamp(value, 0.0, 1.0))));
  });
}

/// The refined limit surface with its exact normals and, if asked for, its numbers.
Scene surface_scene(const Subject& subject, Coloring coloring, const Progress& progress) {
  const Topology control(subject.control, progress);
  const int levels = subject.levels >= 0 ? subject.levels : picture_levels(control);
  const bool curved = coloring == Coloring::Mean || coloring == Coloring::Gaussian;
  Scalars field;
  if (is_scalar(coloring) && !curved) field = vertex_field(subject, control, coloring);
  Topology topology = with_surface_holes(control, subject.scheme);
  Scheme scheme = subject.scheme;
  const Values colors = vertex_colors(subject.control);
  Values values(subject.control.points.rows(), 3 + colors.cols());
  values.leftCols(3) = subject.control.points;
  if (colors.cols() > 0) values.rightCols(colors.cols()) = colors;
  for (int level = 0; level < levels; ++level) {
    Refinement step(topology, scheme, {}, progress);
    values = step.apply(values, progress);
    if (field.size() > 0) {
      field = coloring == Coloring::Sharpness && level < 2
                  ? spread_creases(topology, scheme.kind, field, level, control.vertex_count())
                  : spread(topology, scheme.kind, field);
    }
    topology = step.child();
    scheme = scheme.after_first_step();
  }
  Scene scene;
  const Values limit = LimitMatrix(topology, scheme, {}, progress).apply(values, progress);
  scene.surface.points = limit.leftCols(3);
  if (colors.cols() > 0) scene.colors = linear_colors(limit.rightCols(3));
  const Values normals = limit_normals(topology, scheme, values.leftCols(3), LimitMasks::Exact, progress).corners;
  if (curved) {
    const LimitSurface surface(control, subject.scheme, subject.control.points);
    const Curvature curvature = limit_curvature(surface, topology);
    field = coloring == Coloring::Mean ? curvature.mean : curvature.gaussian;
  }
  std::vector<Index> rows;
  for (Index f = 0; f < topology.face_count(); ++f) {
    if (topology.is_hole(f)) continue;
    for (Index h = topology.face_begin(f); h < topology.face_end(f); ++h) {
      scene.surface.face_vertices.push_back(topology.origin(h));
      rows.push_back(h);
    }
    scene.surface.face_offsets.push_back(static_cast<Index>(scene.surface.face_vertices.size()));
  }
  scene.normals = rows.size() == static_cast<std::size_t>(normals.rows()) ? normals : Values(normals(rows, Eigen::all));
  scene.scalars = field;
  return scene;
}

Scene scene_of(const Subject& subject, Coloring coloring, bool quiet) {
  Scene scene;
  if (subject.flat || subject.control.face_count() == 0) {
    scene.surface = subject.control;
    scene.colors = linear_colors(vertex_colors(subject.control));
    if (coloring == Coloring::Mean || coloring == Coloring::Gaussian) {
      throw Error(
          ErrorCode::BadArgument,
          "only the surface has a curvature, not the mesh as it is: leave --flat out, or choose another --color");
    }
    if (is_scalar(coloring)) scene.scalars = vertex_field(subject, Topology(subject.control), coloring);
  } else {
    scene = surface_scene(subject, coloring, ProgressBar("refining", quiet).callback());
  }
  if (is_scalar(coloring)) {
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
  if (subject.draw_control) scene.lines = subject.control;
  return scene;
}

/// One panel of every picture.
struct Shot {
  const Scene* scene;
  std::string caption;
  Shading shading;
};

std::vector<Viewpoint> viewpoints_of(const std::vector<Shot>& shots, const RenderOptions& options, int around) {
  std::vector<const Scene*> scenes;
  scenes.reserve(shots.size());
  for (const Shot& shot : shots) scenes.push_back(shot.scene);
  if (around > 0) return turntable(scenes, options, around);
  return {fit_viewpoint(scenes, options)};
}

int picture_height(const PictureArguments& arguments, std::size_t panels) {
  return std::max(1, arguments.width * 3 / (4 * static_cast<int>(panels)));
}

RenderOptions render_options(const PictureArguments& arguments, std::size_t panels) {
  RenderOptions options;
  options.samples = arguments.samples;
  options.view = arguments.view;
  options.direction = arguments.direction;
  options.style.transparent = arguments.transparent;
  options.height = arguments.height > 0 ? arguments.height : picture_height(arguments, panels);
  return options;
}

/// Side by side, with a bar at the right where it has pixels; one picture or a turntable.
void draw_shots(const std::vector<Shot>& shots, RenderOptions options, const Panel& bar,
                const PictureArguments& arguments, bool quiet) {
  options.width = (arguments.width - bar.picture.width) / static_cast<int>(shots.size());
  if (options.width < 1) {
    throw Error(ErrorCode::BadArgument, "the picture is too narrow for its colour bar, which takes " +
                                            std::to_string(bar.picture.width) + " pixels; ask for a larger --width");
  }
  const std::vector<Viewpoint> viewpoints = viewpoints_of(shots, options, arguments.turntable);
  ProgressBar progress("drawing", quiet);
  const Progress report = progress.callback();
  const double share = 1.0 / static_cast<double>(viewpoints.size() * shots.size());
  double done = 0.0;
  for (std::size_t i = 0; i < viewpoints.size(); ++i) {
    options.viewpoint = viewpoints[i];
    std::vector<Panel> panels;
    int left = arguments.width - bar.picture.width;
    for (const Shot& shot : shots) {
      RenderOptions own = options;
      own.shading = shot.shading;
      if (&shot == &shots.back()) own.width = left;  // with what the division left over
      left -= own.width;
      const Progress part = [&](double here) { return !report || report(done + share * here); };
      panels.push_back({render(*shot.scene, own, part), shot.caption});
      done += share;
    }
    if (bar.picture.width > 0) panels.push_back(bar);
    const Picture picture = panels.size() == 1 ? std::move(panels.front().picture) : beside(panels, options.style);
    write_png(arguments.turntable > 0 ? numbered(arguments.path, i) : arguments.path, picture);
  }
}

}  // namespace

void draw(const Subject& subject, const PictureArguments& arguments, bool quiet) {
  const Scene after = scene_of(subject, arguments.coloring, quiet);
  Scene before;
  before.surface = subject.before;
  std::vector<Shot> shots;
  if (arguments.before_after) shots.push_back({&before, subject.before_caption, Shading::Plain});
  shots.push_back({&after, arguments.before_after ? subject.after_caption : "",
                   arguments.coloring == Coloring::Zebra ? Shading::Zebra : Shading::Plain});
  RenderOptions options = render_options(arguments, shots.size());
  options.marker_radius = subject.marker_radius;
  Panel bar;
  if (after.scalars.size() > 0 || after.marker_scalars.size() > 0)
    bar.picture = draw_color_bar(after.scale, options.height, options.style);
  draw_shots(shots, options, bar, arguments, quiet);
}

/// Gives the scenes with scalars one scale; returns it, if there are any.
static std::optional<ColorScale> share_scale(std::vector<Scene>& scenes, const ScaleRequest& request) {
  Eigen::Index count = 0;
  for (const Scene& scene : scenes) count += scene.scalars.size();
  if (count == 0) return std::nullopt;
  Scalars all(count);
  Eigen::Index begin = 0;
  for (const Scene& scene : scenes) {
    all.segment(begin, scene.scalars.size()) = scene.scalars;
    begin += scene.scalars.size();
  }
  const ColorScale scale = fit_color_scale(all, request);
  for (Scene& scene : scenes) scene.scale = scale;
  return scale;
}

void draw_row(const std::vector<Subject>& subjects, const PictureArguments& arguments, bool quiet) {
  std::vector<Scene> scenes;
  scenes.reserve(subjects.size());
  for (const Subject& subject : subjects) scenes.push_back(scene_of(subject, arguments.coloring, quiet));
  std::vector<Shot> shots;
  shots.reserve(subjects.size());
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    shots.push_back({&scenes[i], subjects[i].after_caption,
                     arguments.coloring == Coloring::Zebra ? Shading::Zebra : Shading::Plain});
  }
  const RenderOptions options = render_options(arguments, shots.size());
  Panel bar;
  if (!subjects.empty() && subjects.back().numbers.size() > 0) {
    const std::optional<ColorScale> scale = share_scale(scenes, subjects.back().numbers_scale);
    if (scale) bar.picture = draw_color_bar(*scale, options.height, options.style);
  }
  draw_shots(shots, options, bar, arguments, quiet);
}

#else

void draw(const Subject& /*subject*/, const PictureArguments& arguments, bool quiet) { draw_row({}, arguments, quiet); }

void draw_row(const std::vector<Subject>& /*subjects*/, const PictureArguments& /*arguments*/, bool /*quiet*/) {
  throw Error(ErrorCode::NotAvailable, "this build has no pictures; configure with BATTEN_WITH_RENDER=ON");
}

#endif

}  // namespace batten::cli
