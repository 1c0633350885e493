#include "batten/parallel/parallel.h"
#include "cli/common.h"

namespace batten::cli {

int run_convert(const CommonArguments& arguments) {
  const ThreadLimit limit(arguments.threads);
  Stages stages;
  nlohmann::ordered_json repairs;
  const Mesh mesh = read_input(arguments, &repairs);
  stages.finish("read");
  write_output(arguments, mesh);
  stages.finish("write");
  Table table;
  table.add("mesh", size_text(mesh));
  table.add("time", stages.text());
  table.print(arguments);
  write_json(arguments.report, {{"verb", "convert"},
                                {"input", arguments.input},
                                {"output", arguments.output},
                                {"vertices", mesh.vertex_count()},
                                {"faces", mesh.face_count()},
                                {"repairs", repairs},
                                {"seconds", stages.json()}});
  return 0;
}

}  // namespace batten::cli
