#include <string>
#include <vector>

#include "batten/error.h"
#include "batten/io/io.h"
#include "batten/limit/limit_matrix.h"
#include "batten/tessellate/surface_mesh.h"
#include "cli/attributes.h"
#include "cli/interpolation_rows.h"
#include "cli/job.h"
#include "cli/picture.h"

namespace batten::cli {

namespace {

bool is_number(const Attribute& attribute) {
  const bool named = attribute.name == "normal" || attribute.name == "uv" || attribute.name == "color";
  return !attribute.per_corner() && !named;
}

/// The attribute that --values and --value name. Throws Error(BadArgument).
const Attribute& chosen_values(const RenderArguments& arguments, const Mesh& file) {
  std::vector<const Attribute*> found;
  std::string names;
  for (const Attribute& attribute : file.attributes) {
    const bool fits = arguments.value.empty() ? is_number(attribute) : attribute.name == arguments.value;
    if (fits && !attribute.per_corner()) found.push_back(&attribute);
    if (!is_number(attribute)) continue;
    names += names.empty() ? "" : ", ";
    names += attribute.name;
  }
  if (found.size() == 1) return *found.front();
  const std::string have = names.empty() ? ": the file has no numbers at its vertices besides colours and the like"
                                         : "; the file has " + names;
  throw Error(ErrorCode::BadArgument, arguments.values +
                                          (arguments.value.empty() ? ": say by --value which numbers to draw"
                                                                   : ": there is no value '" + arguments.value + "'") +
                                          have);
}

/// Puts the numbers of a file into the subject: of several columns their length.
void add_values(const RenderArguments& arguments, Job& job, Subject& subject) {
  const Mesh file = read_file(arguments.values, "", job.common.quiet, &job.notes);
  const Attribute& chosen = chosen_values(arguments, file);
  if (file.vertex_count() != job.mesh.vertex_count()) {
    throw Error(ErrorCode::BadShape, arguments.values + ": its " +
                                         count_of(file.vertex_count(), "vertex has", "vertices have") +
                                         " numbers, but there are " + grouped(job.mesh.vertex_count()) +
                                         " vertices to draw; both files must have the same vertices");
  }
  const bool one = chosen.values.cols() == 1;
  subject.numbers = one ? Scalars(chosen.values.col(0)) : Scalars(chosen.values.rowwise().norm());
  subject.numbers_scale.title = one ? chosen.name : "length of " + chosen.name;
  if (subject.numbers.size() == 0) return;
  const bool both_signs = subject.numbers.minCoeff() < 0.0 && subject.numbers.maxCoeff() > 0.0;
  subject.numbers_scale.map = both_signs ? ColorMap::Diverging : ColorMap::Sequential;
}

}  // namespace

int run_render(const RenderArguments& arguments) {
  const CommonArguments& common = arguments.common;
  Job job("render", common);
  const Mesh& mesh = job.mesh;
  require_values(common, mesh);
  const Mesh given = arguments.picture.before_after ? mesh : Mesh();
  Subject subject;
  subject.control = &mesh;
  subject.before = &given;
  subject.before_caption = "the mesh as it is";
  subject.after_caption = "its surface";
  subject.flat = arguments.flat || mesh.face_count() == 0;
  subject.draw_control = arguments.control;
  Mesh targets;
  if (!arguments.targets.empty()) {
    targets = read_file(arguments.targets, "", arguments.common.quiet);
    subject.targets = &targets.points;
  }
  if (!arguments.values.empty()) add_values(arguments, job, subject);
  std::string shown = "as it is";
  std::vector<InterpolationReport> solved;
  if (!subject.flat) {
    const Topology topology = job.connect();
    subject.topology = topology;
    subject.scheme = scheme_for(common, mesh);
    solved = prepare_values(topology, subject.scheme, job);
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
  add_value_rows(solved, table);
  job.print(table);
  job.report({{"attributes", named_values_json(solved)}});
  require_reached(solved, InterpolateOptions().tolerance);
  return 0;
}

}  // namespace batten::cli
