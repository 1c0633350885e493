#include <fmt/format.h>

#include <algorithm>

#include "batten/error.h"
#include "batten/expand/morph_surface.h"
#include "batten/expand/resample.h"
#include "batten/io/animation.h"
#include "batten/io/io.h"
#include "batten/mesh/moved_mesh.h"
#include "batten/tessellate/surface_mesh.h"
#include "cli/job.h"
#include "cli/picture.h"

namespace batten::cli {
namespace {

/// One shape between the first and the last.
struct Frame {
  double time;  ///< in [0, 1]; of the paper's sequence the share of its steps
  Values points;
};

/// What all parts of a run need.
struct Run {
  const MorphArguments& arguments;
  const Mesh& mesh;  ///< the first one: connectivity, tags, attributes
  const Topology& topology;
  Scheme scheme;
  bool animated;  ///< a GLB
  int frames;
};

bool is_glb(const CommonArguments& common) {
  return !common.output.empty() && file_format(common.output, common.output_format) == "glb";
}

Mesh read_target(const MorphArguments& arguments, std::vector<std::string>& notes) {
  CommonArguments common = arguments.common;
  common.input = arguments.target;
  return read_input(common, nullptr, &notes);
}

/// The second mesh's points for the first one's vertices.
Values target_points(const Run& run, const Mesh& target, Table& table, nlohmann::ordered_json& report) {
  const bool quiet = run.arguments.common.quiet;
  if (!run.arguments.resample) {
    try {
      require_same_connectivity(run.mesh, target);
    } catch (const Error& error) {
      throw Error(error.code(), std::string(error.what()) +
                                    ". Where both surfaces lie close to each other, --resample "
                                    "gives the second one the faces of the first");
    }
    return target.points;
  }
  const Topology topology(target);
  ProgressBar bar("resampling", quiet);
  constexpr double kReach = 0.25;
  const Resampled found = resample(run.topology, run.scheme, run.mesh.points, topology,
                                   scheme_for(run.arguments.common, target), target.points, kReach, bar.callback());
  std::string text = fmt::format("at most {:.4g} away at vertex {}, mean {:.4g}", found.max_distance,
                                 found.farthest_vertex, found.mean_distance);
  if (found.folded_faces > 0) text += fmt::format("; {} turned over", count_of(found.folded_faces, "face", "faces"));
  table.add("resampled", text);
  report["resampled"] = {{"max_distance", found.max_distance},
                         {"mean_distance", found.mean_distance},
                         {"farthest_vertex", found.farthest_vertex},
                         {"folded_faces", found.folded_faces},
                         {"max_error", found.max_error}};
  return found.control;
}

std::vector<Frame> frames_of(const Run& run, const Morph& morph) {
  std::vector<Frame> frames;
  if (run.arguments.at) {
    frames.push_back({*run.arguments.at, morph.at(*run.arguments.at)});
    return frames;
  }
  for (int i = 0; i < run.frames; ++i) {
    const double time = static_cast<double>(i) / (run.frames - 1);
    frames.push_back({time, morph.at(time)});
  }
  return frames;
}

std::vector<Frame> sequence_frames(const Run& run, const MeshSeries& series, const Values& target) {
  const MorphArguments& arguments = run.arguments;
  const int steps = run.frames - 1;
  const MorphSequenceOptions options{arguments.options.m, *arguments.rho, steps, arguments.align};
  std::vector<Values> sequence = morph_sequence(series, run.mesh.points, target, options,
                                                ProgressBar("morphing", arguments.common.quiet).callback());
  std::vector<Frame> frames;
  for (int i = 0; i <= steps; ++i) {
    frames.push_back({static_cast<double>(i) / steps, std::move(sequence[static_cast<std::size_t>(i)])});
  }
  return frames;
}

void write_frames(const Run& run, const std::vector<Frame>& frames, Job& job) {
  CommonArguments common = run.arguments.common;
  for (std::size_t i = 0; i < frames.size() && !run.arguments.common.output.empty(); ++i) {
    if (!run.arguments.at) common.output = numbered(run.arguments.common.output, i);
    write_output(common, with_points(run.mesh, frames[i].points), job.up);
  }
  job.lost = tell_losses(run.arguments.common, run.mesh);  // all frames lose the same
}

void write_animated(const Run& run, const Morph& morph, Job& job) {
  const CommonArguments& common = run.arguments.common;
  const int levels = run.arguments.levels >= 0 ? run.arguments.levels : std::min(3, picture_levels(run.topology));
  ProgressBar bar("refining", common.quiet);
  const MovingSurface surface = morph_surface(run.topology, run.scheme, run.mesh, morph, levels, run.frames,
                                              run.arguments.seconds, bar.callback());
  ProgressBar writing("writing", common.quiet);
  write_animation(common.output, surface.mesh, surface.targets, {common.output_format, true, job.up},
                  writing.callback());
  job.lost = tell_losses(common, surface.mesh);
}

/// At most six of the frames, the ends among them.
void draw_frames(const Run& run, const std::vector<Frame>& frames, Job& job) {
  constexpr std::size_t kPanels = 6;
  std::vector<Subject> subjects;
  std::vector<Mesh> shapes;
  shapes.reserve(kPanels);
  const std::size_t panels = std::min(frames.size(), kPanels);
  for (std::size_t i = 0; i < panels; ++i) {
    const Frame& frame = frames[panels > 1 ? i * (frames.size() - 1) / (panels - 1) : 0];
    Subject subject;
    shapes.push_back(with_points(run.mesh, frame.points));
    subject.control = &shapes.back();
    subject.topology = run.topology;
    subject.scheme = run.scheme;
    subject.after_caption = fmt::format("{:.2g}", frame.time);
    subjects.push_back(std::move(subject));
  }
  draw_row(subjects, run.arguments.picture, job);
}

std::string what_of(const MorphArguments& arguments) {
  if (arguments.rho) {
    return fmt::format("Lai and Cheng's sequence, rho {:g}, m {}{}", *arguments.rho, arguments.options.m,
                       arguments.align ? ", centroids aligned" : "");
  }
  return fmt::format("{} first, {}, m {}", arguments.options.order == MorphOrder::LowFirst ? "overall shape" : "detail",
                     count_of(arguments.options.stages, "stage", "stages"), arguments.options.m);
}

void add_frames(const Run& run, const std::vector<Frame>& frames, const Values& end, nlohmann::ordered_json& report) {
  report["scheme"] = scheme_json(run.scheme);
  report["order"] = run.arguments.options.order == MorphOrder::LowFirst ? "low-first" : "low-last";
  report["stages"] = run.arguments.options.stages;
  report["m"] = run.arguments.options.m;
  if (run.arguments.rho) report["rho"] = *run.arguments.rho;
  for (const Frame& frame : frames) {
    report["frames"].push_back(
        {{"time", frame.time},
         {"rms_from_start", (frame.points - run.mesh.points).stableNorm() / std::sqrt(run.mesh.vertex_count())},
         {"rms_to_end", (frame.points - end).stableNorm() / std::sqrt(run.mesh.vertex_count())}});
  }
}

}  // namespace

int run_morph(const MorphArguments& arguments) {
  const CommonArguments& common = arguments.common;
  Job job("morph", common);
  const Mesh& mesh = job.mesh;
  const Mesh target = read_target(arguments, job.notes);
  job.stages.finish("read target");
  const Topology topology = job.connect();
  Table table;
  nlohmann::ordered_json report{{"target", arguments.target}};
  Run run{arguments, mesh, topology, scheme_for(common, mesh), is_glb(common), arguments.frames};
  if (run.frames < 0) run.frames = run.animated ? 24 : kMorphFrames;
  table.add("mesh", mesh_text(topology));
  table.add("scheme", scheme_text(run.scheme));
  const Values end = target_points(run, target, table, report);
  const Values moved = end - mesh.points;
  job.stages.finish("match");
  const MeshSeries series(topology, run.scheme, {}, ProgressBar("building", common.quiet).callback());
  std::vector<Frame> frames;
  if (arguments.rho) {
    frames = sequence_frames(run, series, end);
    job.stages.finish("morph");
  } else {
    const Morph morph(series, mesh.points, end, arguments.options, ProgressBar("morphing", common.quiet).callback());
    frames = frames_of(run, morph);
    job.stages.finish("morph");
    if (run.animated) write_animated(run, morph, job);
  }
  if (!run.animated) write_frames(run, frames, job);
  job.stages.finish("write");
  if (!arguments.picture.path.empty()) {
    draw_frames(run, frames, job);
    job.stages.finish("picture");
  }
  double largest = 0.0;  // also where squares leave the doubles
  for (Eigen::Index i = 0; i < moved.rows(); ++i) largest = std::max(largest, moved.row(i).stableNorm());
  table.add("morph", what_of(arguments));
  table.add("moved", fmt::format("at most {:.4g} ({:.3g} of the diagonal)", largest,
                                 largest / std::max(bounding_diagonal(mesh.points), 1e-300)));
  if (!common.output.empty()) {
    const std::string written = run.animated ? fmt::format("an animation of {:g} seconds", arguments.seconds)
                                             : count_of(static_cast<std::int64_t>(frames.size()), "file", "files");
    table.add("written", written);
  }
  job.print(table);
  report["max_movement"] = largest;
  add_frames(run, frames, end, report);
  job.report(report);
  return 0;
}

}  // namespace batten::cli
