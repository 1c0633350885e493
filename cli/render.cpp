#include "batten/io/io.h"
#include "batten/limit/limit_matrix.h"
#include "batten/parallel/parallel.h"
#include "cli/common.h"
#include "cli/picture.h"

namespace batten::cli {

int run_render(const RenderArguments& arguments) {
  const CommonArguments& common = arguments.common;
  const ThreadLimit limit(common.threads);
  Stages stages;
  nlohmann::ordered_json repairs;
  const Mesh mesh = read_input(common, &repairs);
  stages.finish("read");
  Subject subject;
  subject.control = mesh;
  subject.before = arguments.picture.before_after ? mesh : Mesh();
  subject.before_caption = "the mesh as it is";
  subject.after_caption = "its surface";
  subject.flat = arguments.flat || mesh.face_count() == 0;
  subject.draw_control = arguments.control;
  if (!arguments.targets.empty()) subject.targets = read_mesh(arguments.targets).points;
  std::string shown = "as it is";
  if (!subject.flat) {
    const Topology topology(mesh, ProgressBar("connecting", common.quiet).callback());
    subject.scheme = scheme_for(common, mesh);
    subject.levels = arguments.levels >= 0 ? arguments.levels : picture_levels(topology);
    if (arguments.points) subject.markers = LimitMatrix(topology, subject.scheme).apply(mesh.points);
    shown = scheme_text(subject.scheme) + ", " + count_of(subject.levels, "level", "levels") + ", on the limit surface";
  } else if (arguments.points) {
    subject.markers = mesh.points;
  }
  stages.finish("prepare");
  PictureArguments picture = arguments.picture;
  picture.path = common.output;
  draw(subject, picture, common.quiet);
  stages.finish("picture");
  Table table;
  table.add("mesh", size_text(mesh));
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
