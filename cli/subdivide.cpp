#include <fmt/format.h>

#include "batten/limit/surface_mesh.h"
#include "batten/parallel/parallel.h"
#include "batten/refine/refined_mesh.h"
#include "cli/common.h"
#include "cli/picture.h"

namespace batten::cli {

int run_subdivide(const SubdivideArguments& arguments) {
  const CommonArguments& common = arguments.common;
  const int levels = arguments.levels < 0 ? 1 : arguments.levels;
  const ThreadLimit limit(common.threads);
  Stages stages;
  nlohmann::ordered_json repairs;
  const Mesh mesh = read_input(common, &repairs);
  stages.finish("read");
  const Scheme scheme = scheme_for(common, mesh);
  const Topology topology(mesh, ProgressBar("connecting", common.quiet).callback());
  stages.finish("topology");
  ProgressBar bar("refining", common.quiet);
  const Mesh refined = arguments.limit ? surface_mesh(topology, scheme, mesh, levels, bar.callback())
                                       : refine_mesh(topology, scheme, mesh, levels, bar.callback()).mesh;
  stages.finish("subdivide");
  write_output(common, refined);
  stages.finish("write");
  if (!arguments.picture.path.empty()) {
    Subject subject;
    subject.control = refined;
    subject.flat = true;
    subject.before = mesh;
    subject.before_caption = "the mesh given";
    subject.after_caption = "refined " + (levels == 1 ? "once" : std::to_string(levels) + " times");
    draw(subject, arguments.picture, common.quiet);
    stages.finish("picture");
  }
  Table table;
  table.add("mesh", mesh_text(topology));
  table.add("scheme", scheme_text(scheme));
  table.add("refined", fmt::format("{} to {}{}", count_of(levels, "level", "levels"), size_text(refined),
                                   arguments.limit ? ", on the limit surface" : ""));
  table.add("time", stages.text());
  table.print(common);
  write_json(common.report, {{"verb", "subdivide"},
                             {"input", common.input},
                             {"output", common.output},
                             {"repairs", repairs},
                             {"levels", levels},
                             {"limit", arguments.limit},
                             {"scheme", scheme_json(scheme)},
                             {"vertices", refined.vertex_count()},
                             {"faces", refined.face_count()},
                             {"seconds", stages.json()}});
  return 0;
}

}  // namespace batten::cli
