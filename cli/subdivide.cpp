#include <fmt/format.h>

#include <vector>

#include "batten/refine/refined_mesh.h"
#include "batten/tessellate/surface_mesh.h"
#include "cli/attributes.h"
#include "cli/interpolation_rows.h"
#include "cli/job.h"
#include "cli/picture.h"

namespace batten::cli {

int run_subdivide(const SubdivideArguments& arguments) {
  const CommonArguments& common = arguments.common;
  const int levels = arguments.levels < 0 ? 1 : arguments.levels;
  Job job("subdivide", common);
  const Mesh& mesh = job.mesh;
  const Scheme scheme = scheme_for(common, mesh);
  require_values(common, mesh);
  const Topology topology = job.connect();
  const Mesh given = arguments.picture.path.empty() ? Mesh() : mesh;
  const std::vector<InterpolationReport> solved = prepare_values(topology, scheme, job);
  ProgressBar bar("refining", common.quiet);
  const Mesh refined = arguments.limit ? surface_mesh(topology, scheme, mesh, levels, bar.callback())
                                       : refine_mesh(topology, scheme, mesh, levels, bar.callback()).mesh;
  job.stages.finish("subdivide");
  job.write(refined);
  if (!arguments.picture.path.empty()) {
    Subject subject;
    subject.control = &refined;
    subject.flat = true;
    subject.before = &given;
    subject.before_caption = "the mesh given";
    subject.after_caption = "refined " + (levels == 1 ? "once" : std::to_string(levels) + " times");
    draw(subject, arguments.picture, job);
    job.stages.finish("picture");
  }
  Table table;
  table.add("mesh", mesh_text(topology));
  table.add("scheme", scheme_text(scheme));
  table.add("refined", fmt::format("{} to {}{}", count_of(levels, "level", "levels"), size_text(refined),
                                   arguments.limit ? ", on the limit surface" : ""));
  add_value_rows(solved, table);
  job.print(table);
  job.report({{"levels", levels},
              {"limit", arguments.limit},
              {"scheme", scheme_json(scheme)},
              {"vertices", refined.vertex_count()},
              {"faces", refined.face_count()},
              {"attributes", named_values_json(solved)}});
  require_reached(solved, InterpolateOptions().tolerance);
  return 0;
}

}  // namespace batten::cli
