#include <fmt/format.h>

#include "batten/error.h"
#include "batten/io/io.h"
#include "batten/parallel/parallel.h"
#include "cli/input_output.h"
#include "cli/progress.h"
#include "cli/report.h"
#include "cli/table.h"
#include "cli/text.h"

namespace batten::cli {
namespace {

/// What is wrong with all faces, and what can be done with their points.
[[noreturn]] void refuse_nothing(const RepairArguments& arguments, const Mesh& mesh) {
  const std::string way_out = arguments.options.weld > 0.0
                                  ? "weld less (--weld) or nothing (--no-weld)"
                                  : "batten convert writes the points alone as .xyz, and batten fit draws a surface to "
                                    "four or more of them";
  throw Error(ErrorCode::BadArgument,
              fmt::format("{}: no face is left of {}, and nothing was written; none has three different vertices: {}",
                          arguments.common.input, mesh.face_count(), way_out));
}

}  // namespace

int run_repair(const RepairArguments& arguments) {
  const CommonArguments& common = arguments.common;
  const ThreadLimit limit(common.threads);
  Stages stages;
  std::vector<std::string> notes;
  const Mesh mesh = read_file(common.input, common.input_format, common.quiet, &notes);
  stages.finish("read");
  const RepairResult repaired = repair(mesh, arguments.options, ProgressBar("repairing", common.quiet).callback());
  stages.finish("repair");
  if (mesh.face_count() > 0 && repaired.mesh.face_count() == 0) refuse_nothing(arguments, mesh);
  write_output(common, repaired.mesh, up_axis_for(common, mesh));
  const std::vector<std::string> lost = tell_losses(common, repaired.mesh);
  stages.finish("write");
  Table table;
  table.add("mesh", size_text(mesh));
  add_changes(table, "repaired", repaired.changes);
  table.add("result", size_text(repaired.mesh));
  table.add("time", stages.text());
  table.print(common);
  nlohmann::ordered_json json{{"verb", "repair"},
                              {"input", common.input},
                              {"output", common.output},
                              {"notes", notes},
                              {"lost", lost},
                              {"weld", arguments.options.weld},
                              {"vertices_before", mesh.vertex_count()},
                              {"faces_before", mesh.face_count()},
                              {"vertices", repaired.mesh.vertex_count()},
                              {"faces", repaired.mesh.face_count()}};
  json["repairs"] = repairs_json(repaired);
  json["seconds"] = stages.json();
  write_json(common.report, json);
  return 0;
}

}  // namespace batten::cli
