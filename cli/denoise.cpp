/// The verb denoise: removes noise from a mesh.
#include <fmt/format.h>

#include "batten/error.h"
#include "batten/expand/strength.h"
#include "batten/mesh/measures.h"
#include "batten/mesh/moved_mesh.h"
#include "cli/expand.h"
#include "cli/job.h"

namespace batten::cli {
namespace {

std::string removed_text(const DenoiseArguments& arguments, const DenoiseResult& result, double diagonal) {
  const std::string text = fmt::format("{:.4g} rms along the normals ({:.3g} of the diagonal)", result.removed,
                                       diagonal > 0.0 ? result.removed / diagonal : 0.0);
  return arguments.options.automatic
             ? text + fmt::format(", where that noise alone would lose {:.4g}", result.smoothing.removed_noise)
             : text;
}

/// The noise belongs to the mesh given, and so does the mean edge. A mesh in one point has no edge to compare with.
std::string noise_text(double deviation, double mean_edge) {
  const std::string text = fmt::format("{:.4g}", deviation);
  return mean_edge > 0.0 ? text + fmt::format(" ({:.3g} of the mean edge)", deviation / mean_edge) : text;
}

std::string volume_text(const DenoiseArguments& arguments, const DenoiseResult& result) {
  if (result.closed_components == 0) return "none: no component is closed";
  const double change = result.volume_before != 0.0 ? result.volume_after / result.volume_before - 1.0 : 0.0;
  std::string text =
      fmt::format("{:.6g}, was {:.6g} ({:+.2g} %)", result.volume_after, result.volume_before, 100.0 * change);
  if (arguments.options.keep_volume && result.scaled_components < result.closed_components) {
    text += fmt::format("; {} with corners or kept vertices, not scaled",
                        count_of(result.closed_components - result.scaled_components, "component", "components"));
  }
  return text;
}

void print_table(const DenoiseArguments& arguments, const Topology& topology, const Scheme& scheme,
                 const DenoiseResult& result, double diagonal, double mean_edge, const Job& job) {
  const SmoothingChoice& smoothing = result.smoothing;
  Table table;
  table.add("mesh", mesh_text(topology));
  table.add("scheme", weights_text(scheme, arguments.options.matrix));
  if (result.features_left_out > 0) {
    table.add("left out", count_of(result.features_left_out, "sharp edge was", "sharp edges were") +
                              " found, but they make the error to expect hardly smaller");
  }
  table.add("noise", noise_text(result.noise.deviation, mean_edge));
  const double halved = halved_wavelength(scheme.kind, arguments.options.matrix, smoothing.m, smoothing.passes);
  table.add("smoothed", fmt::format("{} with m = {}: {}", count_of(smoothing.passes, "pass", "passes"), smoothing.m,
                                    halved > 0.0 ? fmt::format("halves bumps {:.3g} edges long", halved)
                                                 : std::string("halves no regular bump")));
  table.add("removed", removed_text(arguments, result, diagonal));
  table.add("moved", fmt::format("{:.4g} rms, at most {:.4g} at vertex {}", result.moved, result.most_moved,
                                 result.most_moved_vertex));
  table.add("volume", volume_text(arguments, result));
  job.print(table);
}

nlohmann::ordered_json report_json(const DenoiseArguments& arguments, const Topology& topology, const Scheme& scheme,
                                   const DenoiseResult& result, double diagonal) {
  const SmoothingChoice& smoothing = result.smoothing;
  return {
      {"vertices", topology.vertex_count()},
      {"faces", topology.face_count()},
      {"diagonal", diagonal},
      {"scheme", scheme_json(scheme)},
      {"weights", weights_word(arguments.options.matrix)},
      {"automatic", arguments.options.automatic},
      {"m", smoothing.m},
      {"passes", smoothing.passes},
      {"halved_edge_lengths", halved_wavelength(scheme.kind, arguments.options.matrix, smoothing.m, smoothing.passes)},
      {"noise", result.noise.deviation},
      {"noise_vertices", result.noise.vertices},
      {"removed_rms", result.removed},
      {"expected_removed_rms", smoothing.removed_noise},
      {"expected_error_rms", smoothing.expected_error},
      {"moved_rms", result.moved},
      {"max_moved", result.most_moved},
      {"max_moved_vertex", result.most_moved_vertex},
      {"features", edges_json(result.features)},
      {"features_left_out", result.features_left_out},
      {"closed_components", result.closed_components},
      {"scaled_components", result.scaled_components},
      {"volume_before", result.volume_before},
      {"volume_after", result.volume_after},
      {"peak_memory_bytes", peak_memory_bytes()}};
}

}  // namespace

int run_denoise(const DenoiseArguments& arguments) {
  const CommonArguments& common = arguments.common;
  Job job("denoise", common);
  const Mesh& mesh = job.mesh;
  require_faces(common, mesh);
  const Scheme scheme = scheme_for(common, mesh);
  DenoiseOptions options = arguments.options;
  if (arguments.strength) options.passes = passes_for(scheme.kind, options.matrix, options.m, *arguments.strength);
  options.features = common.features.has_value();
  options.feature_options.degrees = common.features.value_or(options.feature_options.degrees);
  const Topology topology = job.connect_as_given();
  const DenoiseResult result =
      denoise(topology, scheme, mesh.points, options, ProgressBar("smoothing", common.quiet).callback());
  if (common.features) job.features = result.features;
  job.stages.finish("smooth");
  Mesh smooth = with_points(mesh, result.points);
  smooth.creases.insert(smooth.creases.end(), result.features.begin(), result.features.end());
  job.write(smooth);
  if (!arguments.picture.path.empty()) {
    draw_moved(mesh, smooth, arguments.picture, "denoised", job);
    job.stages.finish("picture");
  }
  const double diagonal = bounding_diagonal(mesh.points);
  print_table(arguments, topology, scheme, result, diagonal, edge_lengths(topology, mesh.points).mean, job);
  job.report(report_json(arguments, topology, scheme, result, diagonal));
  return 0;
}

}  // namespace batten::cli
