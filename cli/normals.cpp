#include "cli/normals.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "batten/error.h"
#include "batten/interpolate/wanted_normals.h"
#include "batten/refine/spread_numbers.h"

namespace batten::cli {

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// "3 at creases, 1 where tangents are parallel"; empty if nothing was skipped.
std::string skipped_text(const TurnCounts& counts) {
  const std::pair<Index, const char*> kinds[] = {{counts.crease, "at creases"},
                                                 {counts.corner, "at corners"},
                                                 {counts.valence_two, "between two faces"},
                                                 {counts.degenerate, "where tangents are zero or parallel"},
                                                 {counts.outside, "off the surface"}};
  std::string text;
  for (const auto& [count, words] : kinds) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", grouped(count), words);
  }
  return text;
}

nlohmann::ordered_json angle_json(const VertexMeasure& angle) {
  return {{"max", angle.max / kDegree},
          {"mean", angle.mean / kDegree},
          {"rms", angle.rms / kDegree},
          {"vertex", angle.worst_vertex}};
}

}  // namespace

Values wanted_for(const NormalArguments& arguments, const Topology& topology, Job& job) {
  if (arguments.source.empty()) return Values(0, 3);
  if (arguments.source == kNormalsOfMesh) return stated_wanted_normals(job.mesh, job.common.input);
  if (arguments.source == kNormalsEstimated) return estimated_wanted_normals(topology, job.mesh.points);
  const Mesh file = read_file(arguments.source, "", job.common.quiet, &job.notes);
  if (file.vertex_count() != topology.vertex_count()) {
    throw Error(ErrorCode::BadShape,
                fmt::format("{}: has {}, but {} has {}; normals belong to equally numbered vertices", arguments.source,
                            count_of(file.vertex_count(), "vertex", "vertices"), job.common.input,
                            grouped(topology.vertex_count())));
  }
  return stated_wanted_normals(file, arguments.source);
}

TurnOptions turn_options(double degrees) {
  TurnOptions options;
  options.tolerance = degrees * kDegree;
  return options;
}

TurnReport turn_to(const Values& wanted, const NormalArguments& arguments, InterpolatedMesh& surface, Job& job) {
  TurnOptions options = turn_options(arguments.tolerance);
  options.relax = arguments.relax;
  TurnReport report =
      turn_normals(surface, wanted, options, ProgressBar("turning normals", job.common.quiet).callback());
  job.stages.finish("normals");
  return report;
}

void add_normal_rows(const TurnReport& report, Table& table) {
  const TurnCounts& counts = report.counts;
  std::string text = fmt::format("{} turned, {} right from the start", grouped(counts.turned), grouped(counts.kept));
  if (counts.unwanted > 0) text += fmt::format(", {} not given", grouped(counts.unwanted));
  table.add("normals", text);
  if (const std::string skipped = skipped_text(counts); !skipped.empty())
    table.add("", "left, since the surface has not one normal there: " + skipped);
  if (counts.opposed > 0)
    table.add("", fmt::format("{} off by more than 90 degrees: do the normals point inward there?",
                              count_of(counts.opposed, "normal was", "normals were")));
  if (report.energy.iterations == 0) return;
  table.add("bending", fmt::format("{:.4g} before, {:.4g} turned, {:.4g} relaxed (thin-plate energy)",
                                   report.energy.before, report.energy.turned, report.energy.relaxed));
}

void add_angle_rows(const TurnReport& report, Table& table) {
  const auto text = [](const VertexMeasure& angle) {
    return fmt::format("at most {:.3g} degrees (mean {:.3g}), vertex {}", angle.max / kDegree, angle.mean / kDegree,
                       angle.worst_vertex);
  };
  if (report.before_angle.worst_vertex < 0) return;
  table.add("angle", text(report.before_angle) + (report.counts.turned > 0 ? " before" : ""));
  if (report.counts.turned > 0) table.add("", text(report.after_angle) + " now");
}

nlohmann::ordered_json normals_json(const TurnReport& report) {
  const TurnCounts& counts = report.counts;
  return {{"turned", counts.turned},
          {"kept", counts.kept},
          {"not_given", counts.unwanted},
          {"boundary", counts.boundary},
          {"opposed", counts.opposed},
          {"antiparallel", counts.antiparallel},
          {"skipped",
           {{"crease", counts.crease},
            {"corner", counts.corner},
            {"valence_two", counts.valence_two},
            {"degenerate", counts.degenerate},
            {"outside", counts.outside}}},
          {"angle_before", angle_json(report.before_angle)},
          {"angle_after", angle_json(report.after_angle)},
          {"energy",
           {{"before", report.energy.before},
            {"turned", report.energy.turned},
            {"relaxed", report.energy.relaxed},
            {"iterations", report.energy.iterations}}}};
}

void show_angles(const Scalars& angles, const Topology& given, Subject& subject) {
  subject.numbers = spread_numbers(angles / kDegree, given, subject.scheme.kind, subject.control->vertex_count());
  subject.numbers_scale = {"angle to the normals wanted", "degrees", ColorMap::Sequential};
}

void draw_turned(const InterpolatedMesh& before, const InterpolatedMesh& after, const TurnReport& report,
                 const PictureArguments& arguments, Job& job) {
  std::vector<Subject> subjects(2);
  const InterpolatedMesh* surfaces[] = {&before, &after};
  for (std::size_t i = 0; i < 2; ++i) {
    subjects[i].control = &surfaces[i]->mesh;
    subjects[i].topology = surfaces[i]->topology;
    subjects[i].scheme = surfaces[i]->scheme;
    subjects[i].after_caption = i == 0 ? "through the points" : "and with the normals wanted";
    if (arguments.coloring == Coloring::Normals)
      show_angles(i == 0 ? report.before : report.after, before.topology, subjects[i]);
  }
  draw_row(subjects, arguments, job);
}

}  // namespace batten::cli
