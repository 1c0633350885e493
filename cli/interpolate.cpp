#include <fmt/format.h>

#include <algorithm>

#include "batten/error.h"
#include "batten/io/io.h"
#include "batten/parallel/parallel.h"
#include "batten/tessellate/surface_mesh.h"
#include "cli/job.h"
#include "cli/picture.h"

namespace batten::cli {
namespace {

/// The control mesh that goes to the file: the input with new points, or the refined mesh where alpha acted.
Mesh control_mesh(Mesh mesh, const Topology& topology, const Scheme& scheme, const Interpolant& interpolant,
                  bool quiet) {
  ProgressBar bar("refining", quiet);
  RefinedSurface surface = ordinary_surface(topology, scheme, interpolant, bar.callback());
  const bool same = surface.topology.vertex_count() == topology.vertex_count();
  Mesh control = same ? std::move(mesh) : mesh_from_topology(surface.topology);
  control.points = surface.values;
  state_scheme(scheme, control);
  return control;
}

/// Colours and other numbers at the vertices are interpolated too; normals of the input are not those of control
/// points.
void interpolate_attributes(Mesh& mesh, const Interpolator& interpolator, bool quiet) {
  std::erase_if(mesh.attributes, [](const Attribute& attribute) { return attribute.name == "normal"; });
  for (Attribute& attribute : mesh.attributes) {
    if (attribute.per_corner()) continue;
    ProgressBar bar("interpolating " + attribute.name, quiet);
    attribute.values = interpolator.solve(attribute.values, bar.callback()).control;
  }
}

/// The control mesh, or where a refined surface was asked for, or the format holds nothing else, that surface.
/// Returns what was written when it is not the control mesh.
std::string write_result(const InterpolateArguments& arguments, const Mesh& control, const Scheme& scheme) {
  const CommonArguments& common = arguments.common;
  if (common.output.empty()) return {};
  const bool surface = arguments.levels >= 0 || file_format(common.output, common.output_format) == "glb";
  if (!surface) {
    write_output(common, control);
    return {};
  }
  const Topology topology(control, ProgressBar("connecting", common.quiet).callback());
  const int levels = arguments.levels >= 0 ? arguments.levels : std::min(3, picture_levels(topology));
  ProgressBar bar("refining", common.quiet);
  const Mesh refined = surface_mesh(topology, scheme, control, levels, bar.callback());
  write_output(common, refined);
  return fmt::format("the limit surface refined to {}, {}", count_of(levels, "level", "levels"), size_text(refined));
}

void add_error_rows(Table& table, const Interpolant& result, double diagonal) {
  const Index worst = result.worst.empty() ? -1 : result.worst.front().row;
  table.add("max error", fmt::format("{:.3g} at vertex {} ({:.3g} of the diagonal)", result.max_error, worst,
                                     diagonal > 0.0 ? result.max_error / diagonal : 0.0));
  table.add("rms error", fmt::format("{:.3g}", result.rms_error));
  table.add("moved", fmt::format("at most {:.4g} ({:.3g} of the diagonal)", result.max_movement,
                                 diagonal > 0.0 ? result.max_movement / diagonal : 0.0));
}

std::string singular_text(const Interpolant& result, OnSingular choice) {
  const std::string name = count_of(result.singular_components, "component has", "components have");
  if (!result.vertex_alpha.empty()) {
    return name +
           " no surface through arbitrary points (all valences 3, two-colourable): alpha = 1/2 there, and the result "
           "is "
           "written refined once";
  }
  if (choice == OnSingular::LeastSquares) return name + " a singular system; solved in the least-squares sense";
  return name + " a singular system, but these points have a surface";
}

nlohmann::ordered_json report_json(const InterpolateArguments& arguments, const Topology& topology,
                                   const Scheme& scheme, const Interpolant& result, double diagonal) {
  nlohmann::ordered_json worst = nlohmann::ordered_json::array();
  for (const RowError& entry : result.worst) worst.push_back({{"vertex", entry.row}, {"error", entry.error}});
  return {{"vertices", topology.vertex_count()},
          {"faces", topology.face_count()},
          {"edges", topology.edge_count()},
          {"isolated_vertices", isolated_count(topology)},
          {"diagonal", diagonal},
          {"scheme", scheme_json(scheme)},
          {"method", result.report.method_name},
          {"tolerance", arguments.options.tolerance},
          {"converged", result.report.converged},
          {"iterations", result.report.iterations},
          {"residual_history", result.report.residual_history},
          {"measured_after", result.report.measured_after},
          {"max_error", result.max_error},
          {"rms_error", result.rms_error},
          {"worst_vertices", worst},
          {"max_movement", result.max_movement},
          {"singular_components", result.singular_components},
          {"alpha_used", !result.vertex_alpha.empty()},
          {"peak_memory_bytes", peak_memory_bytes()}};
}

/// The surface with the points that it passes through and its control mesh; colours speak for themselves.
Subject subject_of(const Mesh& given, const Mesh& control, const Scheme& scheme, const PictureArguments& picture) {
  Subject subject;
  subject.control = control;
  subject.scheme = scheme.after_first_step();
  subject.targets = given.points;
  if (picture.coloring == Coloring::None) {
    subject.markers = given.points;
    subject.draw_control = true;
  }
  subject.before = given;
  subject.before_caption = "the mesh given";
  subject.after_caption = "the surface through its points";
  return subject;
}

void print_table(const InterpolateArguments& arguments, const Topology& topology, const Scheme& scheme,
                 const Interpolant& result, double diagonal, const std::string& written, const Job& job) {
  Table table;
  table.add("mesh", mesh_text(topology));
  table.add("scheme", scheme_text(scheme));
  table.add("method", fmt::format("{}, {}", result.report.method_name,
                                  count_of(result.report.iterations, "iteration", "iterations")));
  add_error_rows(table, result, diagonal);
  if (result.singular_components > 0) table.add("singular", singular_text(result, arguments.options.on_singular));
  if (!written.empty()) table.add("written", written);
  job.print(table);
}

/// What was reached is written already; the exit code still has to tell.
void require_tolerance(const Interpolant& result, const InterpolateOptions& options) {
  const bool least_squares = result.singular_components > 0 && options.on_singular == OnSingular::LeastSquares;
  if (!result.report.converged && !least_squares) {
    throw Error(ErrorCode::NotConverged,
                fmt::format("the tolerance {:g} was not reached in {} iterations; what was reached is written{}",
                            options.tolerance, result.report.iterations,
                            options.method == SolveMethod::Auto ? "" : " (try --method auto)"));
  }
}

}  // namespace

int run_interpolate(const InterpolateArguments& arguments) {
  const CommonArguments& common = arguments.common;
  Job job("interpolate", common);
  Mesh& mesh = job.mesh;
  if (mesh.face_count() == 0) {
    throw Error(ErrorCode::BadArgument,
                common.input + ": there are no faces, only points; a surface needs a mesh over its points");
  }
  const Topology topology = job.connect();
  const Scheme scheme = scheme_for(common, mesh);
  const double diagonal = bounding_diagonal(mesh.points);
  const bool drawn = !arguments.picture.path.empty();
  const Mesh given = drawn ? mesh : Mesh();
  const Points targets = arguments.compare_methods ? mesh.points : Points(0, 3);
  std::vector<MethodResult> methods;
  Interpolant result;
  {
    const Interpolator interpolator(topology, scheme, arguments.options,
                                    ProgressBar("building", common.quiet).callback());
    job.stages.finish("build");
    ProgressBar bar("interpolating", common.quiet);
    result = interpolator.solve(mesh.points, bar.callback());
    interpolate_attributes(mesh, interpolator, common.quiet);
  }
  job.stages.finish("solve");
  const Mesh control = control_mesh(std::move(mesh), topology, scheme, result, common.quiet);
  const std::string written = write_result(arguments, control, scheme.after_first_step());
  job.stages.finish("write");
  if (drawn) {
    draw(subject_of(given, control, scheme, arguments.picture), arguments.picture, common.quiet);
    job.stages.finish("picture");
  }
  if (arguments.compare_methods) {
    methods = compare_methods(topology, scheme, arguments.options, targets, common.quiet);
    job.stages.finish("compare");
  }
  if (!arguments.plot.empty() && arguments.compare_methods) {
    plot_methods(arguments.plot, methods, arguments.options.tolerance * diagonal);
    job.stages.finish("plot");
  } else if (!arguments.plot.empty()) {
    plot_residuals(arguments.plot, result.report.method_name, result.report, arguments.options.tolerance * diagonal);
    job.stages.finish("plot");
  }
  print_table(arguments, topology, scheme, result, diagonal, written, job);
  if (arguments.compare_methods) print_methods(methods, diagonal, common);
  nlohmann::ordered_json report = report_json(arguments, topology, scheme, result, diagonal);
  if (arguments.compare_methods) report["compared_methods"] = methods_json(methods);
  job.report(report);
  require_tolerance(result, arguments.options);
  return 0;
}

}  // namespace batten::cli
