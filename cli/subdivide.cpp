#include <fmt/format.h>

#include "batten/limit/limit_matrix.h"
#include "batten/parallel/parallel.h"
#include "cli/common.h"
#include "cli/picture.h"

namespace batten::cli {

int run_subdivide(const SubdivideArguments& arguments) {
  const CommonArguments& common = arguments.common;
  const ThreadLimit limit(common.threads);
  Stages stages;
  nlohmann::ordered_json repairs;
  const Mesh mesh = read_input(common, &repairs);
  stages.finish("read");
  const Scheme scheme = scheme_for(common, mesh);
  const Topology topology =
      with_surface_holes(Topology(mesh, ProgressBar("connecting", common.quiet).callback()), scheme);
  stages.finish("topology");
  ProgressBar bar("refining", common.quiet);
  RefinedSurface surface = refine(topology, scheme, mesh.points, arguments.levels, bar.callback());
  const Scheme last = arguments.levels > 0 ? scheme.after_first_step() : scheme;
  Mesh refined = mesh_from_topology(surface.topology);
  refined.boundary = scheme.boundary;
  if (surface.topology.has_creases()) refined.crease_method = scheme.crease_method;
  for (const Attribute& attribute : mesh.attributes) {
    if (attribute.per_corner() || attribute.name == "normal") continue;
    refined.attributes.push_back(
        {attribute.name, refine(topology, scheme, attribute.values, arguments.levels, bar.callback()).values, {}});
  }
  if (arguments.limit) {
    refined.points = LimitMatrix(surface.topology, last, {}, bar.callback()).apply(surface.values, bar.callback());
    const LimitNormals normals = limit_normals(surface.topology, last, surface.values, {}, bar.callback());
    refined.attributes.push_back({"normal", normals.vertices, {}});
  } else {
    refined.points = surface.values;
  }
  stages.finish("subdivide");
  write_output(common, refined);
  stages.finish("write");
  if (!arguments.picture.path.empty()) {
    Subject subject;
    subject.control = refined;
    subject.flat = true;
    subject.before = mesh;
    subject.before_caption = "the mesh given";
    subject.after_caption = "refined " + (arguments.levels == 1 ? "once" : std::to_string(arguments.levels) + " times");
    draw(subject, arguments.picture, common.quiet);
    stages.finish("picture");
  }
  Table table;
  table.add("mesh", mesh_text(topology));
  table.add("scheme", scheme_text(scheme));
  table.add("refined", fmt::format("{} to {}{}", count_of(arguments.levels, "level", "levels"),
                                   mesh_text(surface.topology), arguments.limit ? ", on the limit surface" : ""));
  table.add("time", stages.text());
  table.print(common);
  write_json(common.report, {{"verb", "subdivide"},
                             {"input", common.input},
                             {"output", common.output},
                             {"repairs", repairs},
                             {"levels", arguments.levels},
                             {"limit", arguments.limit},
                             {"scheme", scheme_json(scheme)},
                             {"vertices", surface.topology.vertex_count()},
                             {"faces", surface.topology.face_count()},
                             {"seconds", stages.json()}});
  return 0;
}

}  // namespace batten::cli
