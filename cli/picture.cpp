#include "cli/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "batten/error.h"
#include "batten/progress.h"
#include "cli/input_output.h"
#include "cli/progress.h"
#ifdef BATTEN_WITH_RENDER
#include "batten/render/panels.h"
#include "cli/scene.h"
#endif

namespace batten::cli {

ScaleRequest mean_curvature_scale() { return {"mean curvature", "1 / unit", ColorMap::Diverging}; }

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

/// How the panels of a picture stand.
struct Layout {
  int columns;
  int rows;

  explicit Layout(std::size_t panels) {
    constexpr int kMostInRow = 3;
    const auto count = static_cast<int>(panels);
    rows = count > kMostInRow ? 2 : 1;
    columns = (count + rows - 1) / rows;
  }
};

/// The options of one panel but for its width.
RenderOptions render_options(const PictureArguments& arguments, const Layout& layout, const Job& job) {
  RenderOptions options;
  options.samples = arguments.samples;
  options.up = job.up;
  options.view = arguments.view;
  options.direction = arguments.direction;
  options.style.transparent = arguments.transparent;
  options.height = arguments.height > 0 ? std::max(1, arguments.height / layout.rows)
                                        : std::max(1, arguments.width * 3 / (4 * layout.columns));
  // Words have the size that they would have in a picture of one panel.
  constexpr double kWords = 3.0 / (4.0 * 34.0);
  constexpr double kMostWords = 1.0 / 8.0;
  options.style.text_size = std::min(kWords * arguments.width, kMostWords * options.height);
  return options;
}

/// In rows, with a bar at the right if there is a scale; one picture or a turntable.
void draw_shots(const std::vector<Shot>& shots, RenderOptions options, const ColorScale* scale,
                const PictureArguments& arguments, Job& job) {
  const Layout layout(shots.size());
  for (const Shot& shot : shots) options.style = style_beside(*shot.scene, options.style);
  const int height = arguments.height > 0 ? arguments.height : options.height * layout.rows;
  const bool has_captions =
      std::any_of(shots.begin(), shots.end(), [](const Shot& shot) { return !shot.caption.empty(); });
  const int below = has_captions ? caption_height(options.style) : 0;
  options.height = std::max(1, options.height - below);
  Panel bar;
  if (scale != nullptr) bar.picture = draw_color_bar(*scale, height, options.style);
  options.width = (arguments.width - bar.picture.width) / layout.columns;
  if (options.width < 1) {
    throw Error(ErrorCode::BadArgument, "the picture is too narrow for its colour bar, which takes " +
                                            std::to_string(bar.picture.width) + " pixels; ask for a larger --width");
  }
  const std::vector<Viewpoint> viewpoints = viewpoints_of(shots, options, arguments.turntable);
  ProgressBar progress("drawing", job.common.quiet);
  const Progress report = progress.callback();
  const double share = 1.0 / static_cast<double>(viewpoints.size() * shots.size());
  std::vector<std::string> notes;  // of the first panel that leaves something out
  double done = 0.0;
  for (std::size_t i = 0; i < viewpoints.size(); ++i) {
    options.viewpoint = viewpoints[i];
    std::vector<Panel> panels;
    for (const Shot& shot : shots) {
      RenderOptions own = options;
      own.shading = shot.shading;
      // The last column and the last row take the remainders of the divisions.
      const auto place = static_cast<int>(panels.size());
      if (place % layout.columns + 1 == layout.columns)
        own.width = arguments.width - bar.picture.width - (layout.columns - 1) * options.width;
      if (place / layout.columns + 1 == layout.rows)
        own.height = height - (layout.rows - 1) * (options.height + below) - below;
      const Progress part = [&](double here) { return !report || report(done + share * here); };
      std::vector<std::string> left_out;
      panels.push_back({render(*shot.scene, own, part, &left_out), shot.caption});
      if (notes.empty()) notes = std::move(left_out);
      done += share;
    }
    Picture picture = in_rows(panels, layout.columns, options.style);
    if (scale != nullptr) picture = beside({{std::move(picture), ""}, bar}, options.style);
    write_png(arguments.turntable > 0 ? numbered(arguments.path, i) : arguments.path, picture);
  }
  for (const std::string& note : notes) {
    job.notes.push_back(arguments.path + ": " + note);
    if (!job.common.quiet) fmt::print(stderr, "batten: {}\n", job.notes.back());
  }
}

}  // namespace

void draw(const Subject& subject, const PictureArguments& arguments, Job& job) {
  const Scene after = scene_of(subject, arguments, job.common.quiet);
  const Scene before = scene_before(subject);
  std::vector<Shot> shots;
  if (arguments.before_after) shots.push_back({&before, subject.before_caption, Shading::Plain});
  shots.push_back({&after, arguments.before_after ? subject.after_caption : "",
                   arguments.coloring == Coloring::Zebra ? Shading::Zebra : Shading::Plain});
  RenderOptions options = render_options(arguments, Layout(shots.size()), job);
  options.marker_radius = subject.marker_radius;
  const bool measures = !after.scale.title.empty();
  draw_shots(shots, options, measures ? &after.scale : nullptr, arguments, job);
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

void draw_row(const std::vector<Subject>& subjects, const PictureArguments& arguments, Job& job) {
  std::vector<Scene> scenes;
  scenes.reserve(subjects.size());
  for (const Subject& subject : subjects) scenes.push_back(scene_of(subject, arguments, job.common.quiet));
  std::vector<Shot> shots;
  shots.reserve(subjects.size());
  for (std::size_t i = 0; i < subjects.size(); ++i) {
    shots.push_back({&scenes[i], subjects[i].after_caption,
                     arguments.coloring == Coloring::Zebra ? Shading::Zebra : Shading::Plain});
  }
  std::optional<ColorScale> scale;
  std::optional<ScaleRequest> request;
  if (!subjects.empty()) request = surface_scale(subjects.back(), arguments.coloring);
  if (request) {
    request->range = arguments.range;
    scale = share_scale(scenes, *request);
  }
  draw_shots(shots, render_options(arguments, Layout(shots.size()), job), scale ? &*scale : nullptr, arguments, job);
}

void draw_frames(Index count, const std::function<Subject(Index)>& subject_of, const PictureArguments& arguments,
                 Job& job) {
  if (count == 0) return;
  const Subject first = subject_of(0);
  const Scene start = scene_of(first, arguments, true);
  const Subject last = subject_of(count - 1);
  const Scene end = scene_of(last, arguments, true);
  RenderOptions options = render_options(arguments, Layout(1), job);
  options.width = arguments.width;
  options.style = style_beside(end, options.style);
  options.marker_radius = last.marker_radius;
  options.viewpoint = fit_viewpoint({&start, &end}, options);
  ProgressBar bar("drawing rounds", job.common.quiet);
  const Progress report = bar.callback();
  for (Index i = 0; i < count; ++i) {
    const Subject subject = subject_of(i);
    const Scene scene = scene_of(subject, arguments, true);
    const Progress part = progress_within(report, static_cast<double>(i) / count, static_cast<double>(i + 1) / count);
    write_png(numbered(arguments.path, static_cast<std::size_t>(i)), render(scene, options, part));
  }
}

#else

void draw_frames(Index /*count*/, const std::function<Subject(Index)>& /*subject_of*/,
                 const PictureArguments& arguments, Job& job) {
  draw_row({}, arguments, job);
}

void draw(const Subject& /*subject*/, const PictureArguments& arguments, Job& job) { draw_row({}, arguments, job); }

void draw_row(const std::vector<Subject>& /*subjects*/, const PictureArguments& /*arguments*/, Job& /*job*/) {
  throw Error(ErrorCode::NotAvailable, "this build has no pictures; configure with BATTEN_WITH_RENDER=ON");
}

#endif

}  // namespace batten::cli
