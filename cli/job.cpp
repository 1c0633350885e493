#include "cli/job.h"

namespace batten::cli {

Job::Job(std::string verb_in, const CommonArguments& arguments)
    : verb(std::move(verb_in)), common(arguments), limit(arguments.threads), mesh(read_input(arguments, &repairs)) {
  stages.finish("read");
}

Topology Job::connect() {
  Topology topology(mesh, ProgressBar("connecting", common.quiet).callback());
  stages.finish("topology");
  return topology;
}

void Job::write(const Mesh& result) {
  write_output(common, result);
  stages.finish("write");
}

void Job::print(Table table) const {
  table.add("time", stages.text());
  table.print(common);
}

void Job::report(const nlohmann::ordered_json& facts) const {
  nlohmann::ordered_json json = {
      {"verb", verb}, {"input", common.input}, {"output", common.output}, {"repairs", repairs}};
  json.update(facts);
  json["threads"] = thread_count();
  json["seconds"] = stages.json();
  write_json(common.report, json);
}

}  // namespace batten::cli
