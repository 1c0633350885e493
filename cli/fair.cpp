/// interpolate --fair.
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "batten/error.h"
#include "batten/expand/surface_fields.h"
#include "batten/interpolate/fair_mesh.h"
#include "batten/tessellate/surface_mesh.h"
#include "cli/attributes.h"
#include "cli/interpolation_rows.h"
#include "cli/job.h"
#include "cli/normals.h"
#include "cli/picture.h"
#include "cli/surface_output.h"

namespace batten::cli {
namespace {

const char* energy_word(ShapeEnergyKind kind) {
  constexpr const char* kWords[] = {"stretch", "bending", "variation"};
  return kWords[static_cast<int>(kind)];
}

FairOptions options_of(const FairArguments& arguments, double diagonal) {
  FairOptions options;
  options.levels = arguments.levels;
  options.energy = arguments.energy;
  if (const std::optional<Length>& length = arguments.smoothing) {
    options.smoothing = length->relative ? length->value * diagonal : length->value;
  }
  return options;
}

/// "46.2, of the plain surface 427 (-89 %)"
std::string energy_text(const FairReport& report) {
  if (!(report.plain_energy > 0.0) || !std::isfinite(report.energy / report.plain_energy))
    return fmt::format("{:.4g}", report.energy);
  const double percent = std::round(100.0 * (report.energy / report.plain_energy - 1.0)) + 0.0;  // no minus before 0
  return fmt::format("{:.4g}, of the plain surface {:.4g} ({:+.0f} %)", report.energy, report.plain_energy, percent);
}

void print_table(const Topology& topology, const Scheme& scheme, const FairOptions& options, const FairMesh& result,
                 const std::string& written, const Job& job) {
  const FairReport& report = result.report;
  Table table;
  table.add("mesh", mesh_text(topology));
  table.add("scheme", scheme_text(scheme));
  table.add("method", "fair, " + method_text(report.solve));
  table.add(energy_word(options.energy), energy_text(report));
  if (report.kept_plain) table.add("", "the plain surface has the least, and is kept");
  table.add("max error", fmt::format("{:.3g} at vertex {} ({})", report.max_error, report.worst_vertex,
                                     share_text(report.max_error, report.diagonal)));
  table.add("rms error", fmt::format("{:.3g}", report.rms_error));
  add_value_rows(result.attributes, table);
  if (report.normal_count > 0) {
    table.add("normals", fmt::format("{} wanted, reached to {:.3g} degrees", grouped(report.normal_count),
                                     report.max_angle * 180.0 / std::numbers::pi));
  }
  table.add("refined", size_text(result.mesh));
  if (!written.empty()) table.add("written", written);
  job.print(table);
}

nlohmann::ordered_json report_json(const Topology& topology, const Scheme& scheme, const FairOptions& options,
                                   const FairMesh& result) {
  const FairReport& report = result.report;
  const auto number_or_null = [](double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
  };
  return {{"vertices", topology.vertex_count()},
          {"faces", topology.face_count()},
          {"edges", topology.edge_count()},
          {"diagonal", report.diagonal},
          {"scheme", scheme_json(scheme)},
          {"method", report.solve.method_name},
          {"converged", report.solve.converged},
          {"iterations", report.solve.iterations},
          {"max_error", report.max_error},
          {"rms_error", report.rms_error},
          {"worst_vertex", report.worst_vertex},
          {"fair",
           {{"levels", report.levels},
            {"energy", energy_word(options.energy)},
            {"smoothing", options.smoothing},
            {"plain_energy", number_or_null(report.plain_energy)},
            {"fair_energy", number_or_null(report.energy)},
            {"kept_plain", report.kept_plain},
            {"normals", report.normal_count},
            {"max_angle", report.max_angle * 180.0 / std::numbers::pi}}},
          {"attributes", named_values_json(result.attributes)},
          {"written_vertices", result.mesh.vertex_count()},
          {"written_faces", result.mesh.face_count()},
          {"peak_memory_bytes", peak_memory_bytes()}};
}

/// A surface with numbers that colours show.
struct ColoredSurface {
  Mesh mesh;
  Scalars numbers;
};

ColoredSurface curved(const FairMesh& result, const Mesh& control) {
  const int levels = picture_levels(result.topology);
  const FieldSurface surface{result.topology, result.scheme, control.points};
  return {surface_mesh(result.topology, result.scheme, control, levels),
          surface_field(surface, SurfaceField::MeanCurvature, levels)};
}

/// The plain surface beside the fair one, in one scale where colours show the mean curvature.
void draw_both(const FairMesh& result, const Points& targets, PictureArguments picture, Job& job) {
  Mesh plain = result.mesh;
  plain.points = result.plain;
  const bool by_curvature = picture.coloring == Coloring::Mean;
  std::vector<ColoredSurface> colored;
  std::vector<Subject> subjects(2);
  for (const Mesh* control : {static_cast<const Mesh*>(&plain), &result.mesh}) {
    colored.push_back(by_curvature ? curved(result, *control) : ColoredSurface{*control, {}});
  }
  for (std::size_t i = 0; i < 2; ++i) {
    Subject& subject = subjects[i];
    subject.control = &colored[i].mesh;
    subject.flat = by_curvature;
    subject.scheme = result.scheme;
    subject.targets = &targets;
    subject.numbers = colored[i].numbers;
    subject.numbers_scale = mean_curvature_scale();
    subject.after_caption = i == 0 ? "plain" : "fair";
    if (picture.coloring == Coloring::None) subject.markers = targets;
  }
  if (by_curvature) picture.coloring = Coloring::None;
  draw_row(subjects, picture, job);
}

void draw_fair(const FairMesh& result, const Points& targets, const PictureArguments& picture, Job& job) {
  if (picture.before_after) return draw_both(result, targets, picture, job);
  Subject subject;
  subject.control = &result.mesh;
  subject.topology = result.topology;
  subject.scheme = result.scheme;
  subject.targets = &targets;
  if (picture.coloring == Coloring::None) subject.markers = targets;
  draw(subject, picture, job);
}

}  // namespace

int run_fair(const InterpolateArguments& arguments) {
  const CommonArguments& common = arguments.common;
  Job job("interpolate", common);
  require_surface(common, job.mesh);
  require_values(common, job.mesh);
  const Topology topology = job.connect();
  const Scheme scheme = scheme_for(common, job.mesh);
  const Points targets = job.mesh.points;
  FairOptions options = options_of(arguments.fair, bounding_diagonal(targets));
  options.normals = wanted_for(arguments.normals, topology, job);
  const AttributeRule rule = common.attributes.value_or(AttributeRule::Interpolated);
  const FairMesh result = interpolate_fairly(topology, scheme, std::move(job.mesh), rule, options,
                                             ProgressBar("interpolating", common.quiet).callback());
  job.stages.finish("solve");
  const std::string written = write_surface({result.mesh, result.topology, result.scheme}, arguments.levels, job);
  if (!arguments.picture.path.empty()) {
    draw_fair(result, targets, arguments.picture, job);
    job.stages.finish("picture");
  }
  print_table(topology, scheme, options, result, written, job);
  job.report(report_json(topology, scheme, options, result));
  require_reached(result.attributes, InterpolateOptions().tolerance);
  if (result.report.solve.converged) return 0;
  throw Error(ErrorCode::NotConverged,
              fmt::format("the surface passes through its points, but is not the fairest yet after {} iterations",
                          result.report.solve.iterations));
}

}  // namespace batten::cli
