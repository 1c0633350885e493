#include "cli/simulation_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "batten/io/io.h"
#include "batten/mesh/moved_mesh.h"
#include "batten/tessellate/moving_surface.h"
#include "batten/tessellate/surface_mesh.h"
#include "cli/film.h"

namespace batten::cli {

SimulationFrames::SimulationFrames(const SimulateArguments& arguments, const ElasticRun& run, Job& job)
    : arguments_(arguments),
      run_(run),
      job_(job),
      animated_(!arguments.common.output.empty() &&
                file_format(arguments.common.output, arguments.common.output_format) == "glb"),
      begins_anew_(arguments.resume.empty()) {
  take(run.frame());
}

std::optional<int> SimulationFrames::levels() const {
  const std::optional<int> asked =
      arguments_.levels >= 0 ? std::optional(arguments_.levels) : run_.scene().output.levels;
  if (!asked) return std::nullopt;
  return std::max(0, *asked - static_cast<int>(run_.refined()));
}

Mesh SimulationFrames::mesh_of(const SimulationFrame& frame) const {
  return with_points(run_.mesh(), run_.refined_points(frame.points, frame.refined));
}

void SimulationFrames::take(Index number) {
  frames_.push_back({number, run_.state().time, run_.refined(), run_.state().positions});
  // A run that goes on has written the frame that it begins with before.
  const bool is_new = frames_.size() > 1 || begins_anew_;
  if (!arguments_.common.output.empty() && !animated_ && is_new) write_file(frames_.back());
}

void SimulationFrames::take_due() {
  if (run_.frame() > frames_.back().number) take(run_.frame());
}

void SimulationFrames::take_last() {
  if (run_.state().time > frames_.back().time) take(frames_.back().number + 1);
}

void SimulationFrames::write_file(const SimulationFrame& frame) {
  CommonArguments common = arguments_.common;
  common.output = numbered(common.output, static_cast<std::size_t>(frame.number));
  Mesh mesh = run_.mesh();
  if (const std::optional<int> depth = levels())
    mesh = surface_mesh(run_.motion().surface().topology(), run_.scheme(), mesh, *depth);
  write_output(common, mesh, job_.up);
  if (files_++ == 0) job_.lost = tell_losses(arguments_.common, mesh);
}

std::string SimulationFrames::finish(bool hurry) {
  const CommonArguments& common = arguments_.common;
  if (common.output.empty()) return {};
  if (!animated_) return count_of(files_, "file", "files");
  const Topology& topology = run_.motion().surface().topology();
  const int depth = levels().value_or(std::min(3, picture_levels(topology)));
  const Mesh first = mesh_of(frames_.front());
  std::vector<Points> shapes;
  std::vector<double> times{0.0};
  for (std::size_t i = 1; i < frames_.size(); ++i) {
    shapes.push_back(run_.refined_points(frames_[i].points, frames_[i].refined));
    times.push_back(frames_[i].time - frames_.front().time);
  }
  ProgressBar refining("refining", common.quiet);
  ProgressBar writing("writing", common.quiet);
  const auto watched = [&](ProgressBar& bar) { return hurry ? Progress() : bar.callback(); };
  const double seconds = times.back();
  const MovingSurface surface =
      surface_through_time(topology, run_.scheme(), first, shapes, std::move(times), depth, watched(refining));
  const WriteOptions options{common.output_format, true, job_.up};
  write_moving_surface(common.output, surface, options, watched(writing));
  job_.lost = tell_losses(common, surface.mesh);
  return fmt::format("an animation of {:g} seconds in {}, {}", seconds,
                     count_of(static_cast<std::int64_t>(frames_.size()), "frame", "frames"), size_text(surface.mesh));
}

}  // namespace batten::cli
