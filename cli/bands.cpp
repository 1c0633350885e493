/// The verb bands: splits a mesh into bands of detail and gives each its gain.
#include <fmt/format.h>

#include <cmath>

#include "batten/error.h"
#include "batten/expand/bands.h"
#include "batten/expand/point_series.h"
#include "batten/mesh/measures.h"
#include "batten/mesh/moved_mesh.h"
#include "cli/expand.h"
#include "cli/job.h"
#include "cli/plots.h"

namespace batten::cli {
namespace {

std::string band_text(const std::vector<Band>& bands, std::size_t j) {
  if (j == 0) return fmt::format("up to {:g} edges", bands[j].longest);
  return j + 1 < bands.size() ? fmt::format("{:g} to {:g} edges", bands[j].shortest, bands[j].longest)
                              : std::string("the rest: the shape");
}

void print_table(const BandsArguments& arguments, const Topology& topology, const Scheme& scheme,
                 const std::vector<Band>& bands, const std::vector<double>& sizes, const std::vector<double>& gains,
                 const Job& job) {
  Table table;
  table.add("mesh", mesh_text(topology));
  table.add("scheme", weights_text(scheme, arguments.matrix));
  for (std::size_t j = 0; j < bands.size(); ++j) {
    table.add(fmt::format("band {}", j + 1),
              fmt::format("{:<20}  rms {:<10.4g}{}", band_text(bands, j), sizes[j],
                          gains[j] != 1.0 ? fmt::format("  times {:g}", gains[j]) : std::string()));
  }
  job.print(table);
}

nlohmann::ordered_json bands_json(const std::vector<Band>& bands, const std::vector<double>& energies,
                                  const std::vector<double>& gains) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (std::size_t j = 0; j < bands.size(); ++j) {
    nlohmann::ordered_json band = {{"shortest_edges", bands[j].shortest}};
    if (std::isfinite(bands[j].longest)) band["longest_edges"] = bands[j].longest;
    band["energy"] = energies[j];
    band["rms"] = std::sqrt(energies[j]);
    band["gain"] = gains[j];
    json.push_back(band);
  }
  return json;
}

nlohmann::ordered_json report_json(const BandsArguments& arguments, const Topology& topology, const Scheme& scheme,
                                   const Mesh& mesh, const nlohmann::ordered_json& bands) {
  return {{"vertices", topology.vertex_count()},
          {"faces", topology.face_count()},
          {"scheme", scheme_json(scheme)},
          {"weights", weights_word(arguments.matrix)},
          {"mean_edge", edge_lengths(topology, mesh.points).mean},
          {"bands", bands}};
}

}  // namespace

int run_bands(const BandsArguments& arguments) {
  const CommonArguments& common = arguments.common;
  Job job("bands", common);
  const Mesh& mesh = job.mesh;
  require_faces(common, mesh);
  const Scheme scheme = scheme_for(common, mesh);
  std::vector<double> gains = arguments.gains;
  if (gains.empty()) gains.assign(static_cast<std::size_t>(arguments.count), 1.0);
  const std::vector<Band> bands = octave_bands(scheme.kind, arguments.matrix, static_cast<int>(gains.size()));
  const Topology topology = job.connect();
  const MeshSeries series(topology, scheme,
                          series_of_points(arguments.matrix, arguments.keep_boundary, topology, mesh.points),
                          ProgressBar("building", common.quiet).callback());
  ProgressBar bar("splitting", common.quiet);
  const Equalized result = equalize(series, mesh.points, bands, gains, bar.callback());
  Mesh mixed = with_points(mesh, result.values);
  if (arguments.displacements) {
    for_each_band(
        series, mesh.points, bands,
        [&](std::size_t j, const Values& band) {
          mixed.attributes.push_back({fmt::format("band_{}", j + 1), band, {}});
        },
        bar.callback());
  }
  job.stages.finish("split");
  job.write(mixed);
  if (!arguments.picture.path.empty()) {
    draw_moved(mesh, mixed, arguments.picture, "mixed", job);
    job.stages.finish("picture");
  }
  std::vector<double> sizes;
  for (const double energy : result.energies) sizes.push_back(std::sqrt(energy));
  if (!arguments.plot.empty()) {
    plot_bands(arguments.plot, bands, sizes, gains);
    job.stages.finish("plot");
  }
  print_table(arguments, topology, scheme, bands, sizes, gains, job);
  job.report(report_json(arguments, topology, scheme, mesh, bands_json(bands, result.energies, gains)));
  return 0;
}

}  // namespace batten::cli
