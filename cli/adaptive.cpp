#include "batten/adaptive/adaptive_surface_mesh.h"

#include <fmt/format.h>

#include <vector>

#include "cli/attributes.h"
#include "cli/interpolation_rows.h"
#include "cli/job.h"
#include "cli/picture.h"

namespace batten::cli {

namespace {

double in_unit(const std::optional<Length>& length, double diagonal) {
  if (!length) return 0.0;
  return length->relative ? length->value * diagonal : length->value;
}

AdaptiveOptions options_of(const SubdivideArguments& arguments, const Scheme& scheme, double diagonal) {
  AdaptiveOptions options;
  options.chord = in_unit(arguments.chord, diagonal);
  options.edge_length = in_unit(arguments.edge_length, diagonal);
  options.angle = arguments.angle.value_or(0.0);
  options.faces =
      arguments.faces.value_or(scheme.kind == SchemeKind::CatmullClark ? FaceKind::Quads : FaceKind::Triangles);
  if (arguments.levels >= 0) options.max_level = arguments.levels;
  if (arguments.max_faces) options.max_faces = *arguments.max_faces;
  return options;
}

/// "0.0031, of 0.005 asked for"
std::string bound_text(double reached, double asked, const std::string& unit) {
  const std::string text = fmt::format("{:.4g}{}", reached, unit);
  return asked > 0.0 ? text + fmt::format(", of {:.4g}{} asked for", asked, unit) : text;
}

void draw_result(const SubdivideArguments& arguments, const Mesh& before, const Mesh& after, Job& job) {
  Subject subject;
  subject.control = &after;
  subject.flat = true;
  subject.draw_control = true;
  subject.before = &before;
  subject.before_caption = "the mesh given";
  subject.after_caption = size_text(after);
  draw(subject, arguments.picture, job);
}

}  // namespace

int run_adaptive(const SubdivideArguments& arguments) {
  const CommonArguments& common = arguments.common;
  Job job("subdivide", common);
  const Mesh& mesh = job.mesh;
  const Scheme scheme = scheme_for(common, mesh);
  require_values(common, mesh);
  const Topology topology = job.connect();
  const Mesh given = arguments.picture.path.empty() ? Mesh() : mesh;
  const std::vector<InterpolationReport> solved = prepare_values(topology, scheme, job);
  const double diagonal = bounding_diagonal(mesh.points);
  const AdaptiveOptions options = options_of(arguments, scheme, diagonal);
  const AdaptiveMesh result =
      adaptive_surface_mesh(topology, scheme, mesh, options, ProgressBar("tessellating", common.quiet).callback());
  job.stages.finish("tessellate");
  // Butterfly surfaces have no closed form to measure by.
  std::optional<double> chord;
  if (!is_interpolating(scheme.kind)) {
    chord = measured_chord(LimitSurface(topology, scheme, mesh.points), result,
                           ProgressBar("measuring", common.quiet).callback());
    job.stages.finish("measure");
  }
  job.write(result.mesh);
  if (!arguments.picture.path.empty()) {
    draw_result(arguments, given, result.mesh, job);
    job.stages.finish("picture");
  }
  Table table;
  table.add("mesh", mesh_text(topology));
  table.add("scheme", scheme_text(scheme));
  table.add("tessellated", fmt::format("to {}, all {}, up to {} deep", size_text(result.mesh),
                                       options.faces == FaceKind::Quads ? "quads" : "triangles",
                                       count_of(result.deepest_level, "level", "levels")));
  if (chord) table.add("chord error", bound_text(*chord, options.chord, ""));
  table.add("longest edge", bound_text(result.longest_edge, options.edge_length, ""));
  if (options.angle > 0.0) table.add("widest angle", bound_text(result.widest_angle, options.angle, "°"));
  if (result.unmet > 0) {
    table.add("not certain",
              fmt::format("in {}, which --levels lets go no deeper", count_of(result.unmet, "cell", "cells")));
  }
  add_value_rows(solved, table);
  job.print(table);
  job.report(
      {{"chord",
        {{"asked", options.chord}, {"measured", chord ? nlohmann::ordered_json(*chord) : nlohmann::ordered_json()}}},
       {"edge_length", {{"asked", options.edge_length}, {"longest", result.longest_edge}}},
       {"angle", {{"asked", options.angle}, {"widest", result.widest_angle}}},
       {"deepest_level", result.deepest_level},
       {"cells_not_certain", result.unmet},
       {"scheme", scheme_json(scheme)},
       {"vertices", result.mesh.vertex_count()},
       {"faces", result.mesh.face_count()},
       {"attributes", named_values_json(solved)}});
  require_reached(solved, InterpolateOptions().tolerance);
  return 0;
}

}  // namespace batten::cli
