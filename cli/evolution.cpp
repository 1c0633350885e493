#include "cli/evolution.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "batten/error.h"
#include "batten/io/io.h"
#include "cli/film.h"
#include "cli/options.h"

namespace batten::cli {

namespace {

constexpr double kFramesPerSecond = 12.0;
/// Rounds are many: a film of them has some 25 faces for each of the last control mesh.
constexpr int kFilmLevels = 2;

std::string in_folder(const std::string& folder, const std::string& name) {
  return (std::filesystem::path(folder) / name).string();
}

void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!std::filesystem::is_directory(folder, error))
    throw Error(ErrorCode::FileNotWritable, folder + ": cannot be made a folder; name one that may be written");
}

}  // namespace

void add_evolution(CLI::App& verb, EvolutionArguments& arguments) {
  verb.add_option("--frames", arguments.folder,
                  "write the control mesh of each round into this folder, as round-000.obj and so on, and with "
                  "--picture a picture of each beside it")
      ->option_text("DIR");
  verb.add_option("--moments", arguments.moments,
                  "with --picture: so many rounds side by side, first and last among them, instead of the result alone")
      ->check(whole_number(2, 12));
  add_output_file(verb, "--film", arguments.film, "write the surfaces of all rounds as an animation", {".glb"});
}

Evolution::Evolution(const EvolutionArguments& arguments, std::string comment)
    : arguments_(arguments), comment_(std::move(comment)) {
  if (!arguments_.folder.empty()) make_folder(arguments_.folder);
}

FrameWatcher Evolution::watcher() {
  if (!arguments_.wanted()) return {};
  return [this](const SurfaceFrame& frame) { film_.add(frame); };
}

std::string Evolution::write(const PictureArguments& picture, const Points& markers, double marker_radius,
                             Job& job) const {
  if ((arguments_.folder.empty() && arguments_.film.empty()) || film_.size() == 0) return {};
  if (!arguments_.folder.empty()) {
    write_meshes(job);
    if (!picture.path.empty()) draw(picture, markers, marker_radius, job);
  }
  if (!arguments_.film.empty()) write_film(job);
  job.stages.finish("frames");
  std::string text = count_of(film_.size(), "frame", "frames");
  if (!arguments_.folder.empty()) text += " in " + arguments_.folder;
  if (!arguments_.film.empty())
    text += fmt::format("{} {} of {:.3g} seconds", arguments_.folder.empty() ? "," : " and", arguments_.film,
                        (film_.size() - 1) / kFramesPerSecond);
  return text;
}

void Evolution::write_meshes(Job& job) const {
  for (Index i = 0; i < film_.size(); ++i) {
    const std::string path = numbered(in_folder(arguments_.folder, "round.obj"), static_cast<std::size_t>(i));
    WriteOptions options{"", true, job.up};
    options.comment = comment_;
    write_mesh(path, frame_mesh(film_.frame(i)), options);
  }
}

void Evolution::draw(const PictureArguments& picture, const Points& markers, double marker_radius, Job& job) const {
  PictureArguments own = picture;
  own.path = in_folder(arguments_.folder, "round.png");
  Mesh mesh;
  draw_frames(
      film_.size(), [&](Index i) { return subject_of(i, markers, marker_radius, mesh); }, own, job);
}

Subject Evolution::subject_of(Index frame, const Points& markers, double marker_radius, Mesh& mesh) const {
  const SurfaceFrame& shown = film_.frame(frame);
  mesh = frame_mesh(shown);
  Subject subject;
  subject.control = &mesh;
  subject.topology = shown.topology;
  subject.scheme = shown.scheme;
  subject.draw_control = true;
  subject.markers = markers;
  subject.marker_radius = marker_radius;
  return subject;
}

void Evolution::draw_moments(const PictureArguments& picture, const Points& markers, double marker_radius,
                             Job& job) const {
  const Index panels = std::min(film_.size(), static_cast<Index>(arguments_.moments.value_or(1)));
  std::vector<Mesh> meshes(static_cast<std::size_t>(panels));
  std::vector<Subject> subjects;
  for (Index i = 0; i < panels; ++i) {
    const Index frame = panels > 1 ? static_cast<Index>(std::int64_t{i} * (film_.size() - 1) / (panels - 1)) : 0;
    Mesh& mesh = meshes[static_cast<std::size_t>(i)];
    subjects.push_back(subject_of(frame, markers, marker_radius, mesh));
    subjects.back().after_caption = fmt::format(
        "{}, {} control points", frame == 0 ? "start" : fmt::format("round {}", frame), mesh.vertex_count());
  }
  draw_row(subjects, picture, job);
}

void Evolution::write_film(Job& job) const {
  const MovingSurface surface =
      film_.moving(kFramesPerSecond, kFilmLevels, ProgressBar("refining", job.common.quiet).callback());
  write_moving_surface(arguments_.film, surface, {"glb", true, job.up},
                       ProgressBar("writing", job.common.quiet).callback());
}

}  // namespace batten::cli
