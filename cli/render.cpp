#include "batten/io/io.h"
#include "batten/limit/limit_matrix.h"
#include "batten/tessellate/surface_mesh.h"
#include "cli/job.h"
#include "cli/picture.h"

namespace batten::cli {

int run_render(const RenderArguments& arguments) {
  const CommonArguments& common = arguments.common;
  Job job("render", common);
  const Mesh& mesh = job.mesh;
  Subject subject;
  subject.control = &mesh;
  subject.before = &mesh;
  subject.before_caption = "the mesh as it is";
  subject.after_caption = "its surface";
  subject.flat = arguments.flat || mesh.face_count() == 0;
  subject.draw_control = arguments.control;
  Mesh targets;
  if (!arguments.targets.empty()) {
    targets = read_file(arguments.targets, "", arguments.common.quiet);
    subject.targets = &targets.points;
  }
  std::string shown = "as it is";
  if (!subject.flat) {
    const Topology topology = job.connect();
    subject.topology = topology;
    subject.scheme = scheme_for(common, mesh);
    subject.levels = arguments.levels >= 0 ? arguments.levels : picture_levels(topology);
    if (arguments.points) subject.markers = LimitMatrix(topology, subject.scheme).apply(mesh.points);
    shown = scheme_text(subject.scheme) + ", " + count_of(subject.levels, "level", "levels") + ", on the limit surface";
  } else if (arguments.points) {
    subject.markers = mesh.points;
  }
  job.stages.finish("prepare");
  PictureArguments picture = arguments.picture;
  picture.path = common.output;
  draw(subject, picture, job);
  job.stages.finish("picture");
  Table table;
  table.add("mesh", size_text(mesh));
  table.add("drawn", shown);
  job.print(table);
  job.report();
  return 0;
}

}  // namespace batten::cli
