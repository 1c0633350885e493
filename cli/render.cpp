#include "batten/limit/limit_matrix.h"
#include "batten/parallel/parallel.h"
#include "cli/common.h"

namespace batten::cli {

int run_render(const RenderArguments& arguments) {
  const CommonArguments& common = arguments.common;
  const ThreadLimit limit(common.threads);
  Stages stages;
  nlohmann::ordered_json repairs;
  const Mesh mesh = read_input(common, &repairs);
  stages.finish("read");
  Mesh surface = mesh;
  Points markers(0, 3);
  std::string shown = "as it is";
  if (!arguments.flat && mesh.face_count() > 0) {
    const Topology topology(mesh, ProgressBar("connecting", common.quiet).callback());
    const Scheme scheme = scheme_for(common, mesh);
    const int levels = arguments.levels >= 0 ? arguments.levels : picture_levels(topology);
    surface = limit_mesh(topology, scheme, mesh.points, levels, common.quiet);
    if (arguments.points) markers = LimitMatrix(topology, scheme).apply(mesh.points);
    shown = scheme_text(scheme) + ", " + count_of(levels, "level", "levels") + ", on the limit surface";
  } else if (arguments.points) {
    markers = mesh.points;
  }
  stages.finish("refine");
  draw(surface, markers, arguments.control ? mesh : Mesh(),
       {common.output, arguments.width, arguments.height, arguments.samples, arguments.view, common.quiet});
  stages.finish("picture");
  Table table;
  table.add("mesh",
            count_of(mesh.vertex_count(), "vertex", "vertices") + ", " + count_of(mesh.face_count(), "face", "faces"));
  table.add("drawn", shown);
  table.add("time", stages.text());
  table.print(common);
  write_json(common.report, {{"verb", "render"},
                             {"input", common.input},
                             {"output", common.output},
                             {"repairs", repairs},
                             {"seconds", stages.json()}});
  return 0;
}

}  // namespace batten::cli
