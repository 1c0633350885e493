#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "batten/error.h"
#include "batten/interpolate/interpolated_mesh.h"
#include "batten/mesh/vertex_fields.h"
#include "cli/attributes.h"
#include "cli/compare.h"
#include "cli/interpolation_rows.h"
#include "cli/job.h"
#include "cli/normals.h"
#include "cli/picture.h"
#include "cli/plots.h"
#include "cli/surface_output.h"

namespace batten::cli {
namespace {

void add_error_rows(Table& table, const std::vector<InterpolationReport>& reports) {
  const InterpolationReport& points = reports.front();
  table.add("max error", error_text(points));
  table.add("rms error", fmt::format("{:.3g}", points.rms_error));
  if (points.outcome != Outcome::Reached) table.add("reached", outcome_text(points.outcome));
  table.add("moved",
            fmt::format("at most {:.4g} ({})", points.max_movement, share_text(points.max_movement, points.diagonal)));
  add_value_rows({reports.begin() + 1, reports.end()}, table);
}

const char* reason_text(SingularReason reason) {
  switch (reason) {
    case SingularReason::TwoColourable:
      return "all valences 3, two-colourable";
    case SingularReason::ValenceTwo:
      return "vertices of valence 2";
    case SingularReason::Unsolvable:
      break;
  }
  return "no method solves it";
}

std::string treatment_text(const SingularReport& component) {
  switch (component.treatment) {
    case SingularTreatment::None:
      return "but these points have a surface";
    case SingularTreatment::LeastSquares:
      return "solved in the least-squares sense";
    case SingularTreatment::Alpha:
      break;
  }
  return fmt::format("alpha = {} there, written refined once",
                     component.alpha == 0.5 ? std::string("1/2") : fmt::format("{:g}", component.alpha));
}

bool alike(const SingularReport& a, const SingularReport& b) {
  return a.reason == b.reason && a.treatment == b.treatment && a.alpha == b.alpha;
}

/// One row for the components that are singular for the same reason and treated alike.
void add_singular_rows(Table& table, const InterpolationReport& report) {
  std::vector<SingularReport> left = report.singular;
  std::string name = report.name == "points" ? "singular" : "singular for " + report.name;
  while (!left.empty()) {
    const SingularReport first = left.front();
    const auto count = std::count_if(left.begin(), left.end(), [&](const auto& one) { return alike(one, first); });
    table.add(name, fmt::format(
                        "{} no surface through arbitrary points ({}; {}{}): {}",
                        count_of(count, "component has", "components have"), reason_text(first.reason),
                        count > 1 ? "the first at " : "",
                        fmt::format("vertex {}, {}", first.vertex, count_of(first.vertex_count, "vertex", "vertices")),
                        treatment_text(first)));
    std::erase_if(left, [&](const auto& one) { return alike(one, first); });
    name.clear();
  }
}

void add_all_singular_rows(Table& table, const std::vector<InterpolationReport>& reports) {
  for (const InterpolationReport& report : reports) {
    const std::vector<SingularReport>& first = reports.front().singular;
    const bool told = &report != &reports.front() &&
                      std::equal(report.singular.begin(), report.singular.end(), first.begin(), first.end(), alike);
    if (!told) add_singular_rows(table, report);
  }
}

nlohmann::ordered_json report_json(const InterpolateArguments& arguments, const Topology& topology,
                                   const Scheme& scheme, const InterpolatedMesh& result) {
  const InterpolationReport& points = result.reports.front();
  nlohmann::ordered_json json{{"vertices", topology.vertex_count()},
                              {"faces", topology.face_count()},
                              {"edges", topology.edge_count()},
                              {"isolated_vertices", isolated_count(topology)},
                              {"diagonal", points.diagonal},
                              {"scheme", scheme_json(scheme)},
                              {"tolerance", arguments.options.tolerance}};
  json.update(values_json(points));
  json["singular_components"] = points.singular.size();
  json["alpha_used"] = std::any_of(points.singular.begin(), points.singular.end(),
                                   [](const SingularReport& one) { return one.treatment == SingularTreatment::Alpha; });
  json["refined_once"] = result.is_refined;
  json["written_vertices"] = result.topology.vertex_count();
  json["written_faces"] = result.topology.face_count();
  json["attributes"] = named_values_json({result.reports.begin() + 1, result.reports.end()});
  json["peak_memory_bytes"] = peak_memory_bytes();
  return json;
}

/// The surface of the points, and what became of it where normals are wanted.
struct InterpolationRun {
  const InterpolateArguments& arguments;
  const Topology& topology;  ///< of the mesh given
  const Scheme& scheme;
  InterpolatedMesh result;
  Topology solved;  ///< of the control mesh before normals were turned
  std::optional<TurnReport> turned;

  bool refined_twice() const { return result.topology.vertex_count() != solved.vertex_count(); }
};

/// The surface with the points that it passes through and its control mesh; without these two where colours show
/// numbers.
Subject subject_of(const Mesh& given, const InterpolationRun& run) {
  const InterpolatedMesh& result = run.result;
  Subject subject;
  subject.control = &result.mesh;
  subject.topology = result.topology;
  subject.scheme = result.scheme;
  subject.targets = &given.points;
  if (run.arguments.picture.coloring == Coloring::None) {
    subject.markers = given.points;
    subject.draw_control = true;
  }
  if (run.arguments.picture.coloring == Coloring::Normals) show_angles(run.turned->after, run.solved, subject);
  subject.before = &given;
  subject.before_caption = "the mesh given";
  subject.after_caption = "the surface through its points";
  return subject;
}

/// "1,642 vertices became 2,130, 1,500 faces became 2,400"
std::string growth_text(const Topology& before, const Topology& after) {
  return fmt::format("{} became {}, {} became {}", count_of(before.vertex_count(), "vertex", "vertices"),
                     grouped(after.vertex_count()), count_of(before.face_count(), "face", "faces"),
                     grouped(after.face_count()));
}

/// "8 components once, where alpha acts: ..."
std::string refined_text(const InterpolationRun& run) {
  const std::vector<SingularReport>& singular = run.result.reports.front().singular;
  const auto count = std::count_if(singular.begin(), singular.end(),
                                   [](const SingularReport& one) { return one.treatment == SingularTreatment::Alpha; });
  const std::string what = run.solved.face_count() == run.topology.half_edge_count()
                               ? std::string("the whole mesh")
                               : count_of(count, "component", "components");
  return what + " once, where alpha acts: " + growth_text(run.topology, run.solved);
}

void print_table(const InterpolationRun& run, const std::string& written, const Job& job) {
  const std::vector<InterpolationReport>& reports = run.result.reports;
  Table table;
  table.add("mesh", mesh_text(run.topology));
  table.add("scheme", scheme_text(run.scheme));
  table.add("method", method_text(reports.front().solve));
  add_error_rows(table, reports);
  add_all_singular_rows(table, reports);
  if (run.result.is_refined) table.add("refined", refined_text(run));
  if (run.turned) {
    add_normal_rows(*run.turned, table);
    add_angle_rows(*run.turned, table);
  }
  if (run.refined_twice())
    table.add("refined", "twice, so that normals can turn: " + growth_text(run.solved, run.result.topology));
  if (!written.empty()) table.add("written", written);
  job.print(table);
}

InterpolatedMesh solve(const InterpolateArguments& arguments, const Topology& topology, const Scheme& scheme,
                       Job& job) {
  const bool quiet = arguments.common.quiet;
  const Interpolator interpolator(topology, scheme, arguments.options, ProgressBar("building", quiet).callback());
  job.stages.finish("build");
  try {
    ProgressBar bar("interpolating", quiet);
    const AttributeRule rule = arguments.common.attributes.value_or(AttributeRule::Interpolated);
    InterpolatedMesh result = interpolate(interpolator, std::move(job.mesh), rule, bar.callback());
    job.stages.finish("solve");
    return result;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::SingularSystem) throw;
    throw Error(error.code(), error.what() + std::string(" (--on-singular alpha|least-squares)"));
  }
}

/// The papers' iterations and ours, and the plot of either.
std::vector<MethodResult> compare_and_plot(const InterpolateArguments& arguments, const Topology& topology,
                                           const Scheme& scheme, const Points& targets,
                                           const InterpolationReport& report, Job& job) {
  const double tolerance = arguments.options.tolerance * report.diagonal;
  std::vector<MethodResult> methods;
  if (arguments.compare_methods) {
    ProgressBar bar("comparing", arguments.common.quiet);
    methods = compare_methods(topology, scheme, arguments.options, targets, bar.callback());
    job.stages.finish("compare");
  }
  if (arguments.plot.empty()) return methods;
  if (arguments.compare_methods) {
    plot_methods(arguments.plot, methods, tolerance);
  } else {
    plot_residuals(arguments.plot, report.solve.method_name, report.solve, tolerance);
  }
  job.stages.finish("plot");
  return methods;
}

}  // namespace

int run_interpolate(const InterpolateArguments& arguments) {
  const CommonArguments& common = arguments.common;
  Job job("interpolate", common);
  require_surface(common, job.mesh);
  require_values(common, job.mesh);
  const Topology topology = job.connect();
  const Scheme scheme = scheme_for(common, job.mesh);
  const bool drawn = !arguments.picture.path.empty();
  const Mesh given = drawn ? job.mesh : Mesh();
  const Points targets = arguments.compare_methods ? job.mesh.points : Points(0, 3);
  const Values wanted = wanted_for(arguments.normals, topology, job);
  InterpolatedMesh solved = solve(arguments, topology, scheme, job);
  const Topology control = solved.topology;
  InterpolationRun run{arguments, topology, scheme, std::move(solved), control, {}};
  const InterpolatedMesh& result = run.result;
  const bool compared = drawn && arguments.picture.before_after && wanted.rows() > 0;
  const InterpolatedMesh before = compared ? result : InterpolatedMesh{{}, topology, scheme, {}, false};
  if (wanted.rows() > 0) run.turned = turn_to(wanted, arguments.normals, run.result, job);
  const std::string written = write_surface({result.mesh, result.topology, result.scheme}, arguments.levels, job);
  if (drawn) {
    if (compared) {
      draw_turned(before, result, *run.turned, arguments.picture, job);
    } else {
      draw(subject_of(given, run), arguments.picture, job);
    }
    job.stages.finish("picture");
  }
  const InterpolationReport& points = result.reports.front();
  const std::vector<MethodResult> methods = compare_and_plot(arguments, topology, scheme, targets, points, job);
  print_table(run, written, job);
  if (arguments.compare_methods) print_methods(methods, points.diagonal, common);
  nlohmann::ordered_json report = report_json(arguments, topology, scheme, result);
  if (run.turned) report["normals"] = normals_json(*run.turned);
  if (arguments.compare_methods) report["compared_methods"] = methods_json(methods);
  job.report(report);
  require_reached(result.reports, arguments.options.tolerance,
                  arguments.options.method == SolveMethod::Auto ? "" : "try --method auto");
  return 0;
}

}  // namespace batten::cli
