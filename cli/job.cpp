#include "cli/job.h"

#include <fmt/format.h>

#include "batten/expand/features.h"
#include "batten/mesh/seams.h"

namespace batten::cli {

Job::Job(std::string verb_in, const CommonArguments& arguments)
    : Job(
          std::move(verb_in), arguments, [this] { mesh = read_input(common, &repairs, &notes); }, UpAxis::Z) {
  up = up_axis_for(arguments, mesh);
}

Job::Job(std::string verb_in, const CommonArguments& arguments, const std::function<void()>& read, UpAxis usual_up)
    : verb(std::move(verb_in)),
      common(arguments),
      limit(arguments.threads),
      up(arguments.up == UpAxis::Auto ? usual_up : arguments.up) {
  read();
  stages.finish("read");
}

Topology Job::connect() {
  Topology topology = connect_as_given();
  if (!common.features) return topology;
  FeatureOptions options;
  options.degrees = *common.features;
  features = find_features(topology, mesh.points, options, ProgressBar("looking for edges", common.quiet).callback());
  mesh.creases.insert(mesh.creases.end(), features->begin(), features->end());
  if (!features->empty()) topology = Topology(mesh, ProgressBar("connecting", common.quiet).callback());
  stages.finish("features");
  return topology;
}

Topology Job::connect_as_given() {
  Topology topology(mesh, ProgressBar("connecting", common.quiet).callback());
  seam_vertices = coincident_boundary_count(topology, mesh.points);
  if (*seam_vertices > 0 && !common.quiet) {
    fmt::print(stderr, "batten: {}\n", seams_text(*seam_vertices, common.repair));
  }
  stages.finish("topology");
  return topology;
}

void Job::write(const Mesh& result) {
  write_output(common, result, up);
  lost = tell_losses(common, result);
  stages.finish("write");
}

void Job::print(Table table) const {
  if (features) table.add("features", features_text(*features, *common.features));
  table.add("time", stages.text());
  table.print(common);
}

void Job::report(const nlohmann::ordered_json& facts) const {
  nlohmann::ordered_json json = {{"verb", verb},       {"input", common.input}, {"output", common.output},
                                 {"repairs", repairs}, {"notes", notes},        {"lost", lost}};
  json.update(facts);
  if (features) json["features"] = edges_json(*features);
  if (seam_vertices) json["coincident_boundary_vertices"] = *seam_vertices;
  json["threads"] = thread_count();
  json["seconds"] = stages.json();
  write_json(common.report, json);
}

}  // namespace batten::cli
