/// The verb sharpen: makes detail stronger.
#include <fmt/format.h>

#include "batten/mesh/moved_mesh.h"
#include "cli/expand.h"
#include "cli/job.h"

namespace batten::cli {
namespace {

nlohmann::ordered_json pairs_json(const SelfIntersections& found) {
  return {{"count", found.count}, {"faces", found.faces}};
}

/// The text on faces that pass through each other or fold over, or that none do.
std::string check_text(const SharpenResult& result) {
  std::string text =
      result.after.count == 0
          ? std::string("no faces pass through each other")
          : fmt::format("WARNING: {} through each other, such as {} and {}",
                        count_of(result.after.count, "pair of triangles passes", "pairs of triangles pass"),
                        result.after.faces.front()[0], result.after.faces.front()[1]);
  if (result.before.count > 0) text += fmt::format("; {} did before", grouped(result.before.count));
  if (result.turned_faces > 0)
    text += fmt::format("; WARNING: {} over", count_of(result.turned_faces, "face folded", "faces folded"));
  return text;
}

void print_table(const SharpenArguments& arguments, const Topology& topology, const Scheme& scheme,
                 const SharpenResult& result, const Job& job) {
  const SharpenOptions& options = arguments.options;
  Table table;
  table.add("mesh", mesh_text(topology));
  table.add("scheme", weights_text(scheme, options.matrix));
  table.add("sharpened", fmt::format("{} of the terms {} to {}, amount {:.3g}{}",
                                     count_of(options.passes, "pass", "passes"), options.m, options.n, result.amount,
                                     result.amount < options.amount
                                         ? fmt::format(" ({:g} would be too much: see --most-growth)", options.amount)
                                         : std::string()));
  table.add("growth", fmt::format("at most {:.3g} times, of the finest detail", result.growth));
  table.add("moved", fmt::format("{:.4g} rms, at most {:.4g} at vertex {}", result.moved, result.most_moved,
                                 result.most_moved_vertex));
  if (options.check) table.add("check", check_text(result));
  job.print(table);
}

nlohmann::ordered_json report_json(const SharpenArguments& arguments, const Topology& topology, const Scheme& scheme,
                                   const SharpenResult& result) {
  const SharpenOptions& options = arguments.options;
  nlohmann::ordered_json json = {{"vertices", topology.vertex_count()},
                                 {"faces", topology.face_count()},
                                 {"scheme", scheme_json(scheme)},
                                 {"weights", weights_word(options.matrix)},
                                 {"m", options.m},
                                 {"n", options.n},
                                 {"passes", options.passes},
                                 {"asked_amount", options.amount},
                                 {"amount", result.amount},
                                 {"growth", result.growth},
                                 {"moved_rms", result.moved},
                                 {"max_moved", result.most_moved},
                                 {"max_moved_vertex", result.most_moved_vertex}};
  if (options.check) {
    json["intersections_before"] = pairs_json(result.before);
    json["intersections_after"] = pairs_json(result.after);
    json["turned_faces"] = result.turned_faces;
  }
  return json;
}

}  // namespace

int run_sharpen(const SharpenArguments& arguments) {
  const CommonArguments& common = arguments.common;
  Job job("sharpen", common);
  const Mesh& mesh = job.mesh;
  require_faces(common, mesh);
  const Scheme scheme = scheme_for(common, mesh);
  const Topology topology = job.connect();
  ProgressBar bar("sharpening", common.quiet);
  const SharpenResult result = sharpen(topology, scheme, mesh.points, arguments.options, bar.callback());
  job.stages.finish("sharpen");
  const Mesh sharp = with_points(mesh, result.points);
  job.write(sharp);
  if (!arguments.picture.path.empty()) {
    draw_moved(mesh, sharp, arguments.picture, "sharpened", job);
    job.stages.finish("picture");
  }
  print_table(arguments, topology, scheme, result, job);
  job.report(report_json(arguments, topology, scheme, result));
  return 0;
}

}  // namespace batten::cli
