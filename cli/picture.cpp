#include "cli/picture.h"

#include <algorithm>

#include "batten/error.h"
#include "cli/input_output.h"
#include "cli/progress.h"
#ifdef BATTEN_WITH_RENDER
#include "batten/render/panels.h"
#include "cli/scene.h"
#endif

namespace batten::cli {

ScaleRequest mean_curvature_scale() {
  return {"mean curvature", "1 / unit", ColorMap::Diverging, 0.0, false, false, kWildShare};
}

#ifdef BATTEN_WITH_RENDER

namespace {

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
      if (&shot == &shots.back()) own.width = left;  // the last panel takes the remainder of the division
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
  const Scene before = scene_before(subject);
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
