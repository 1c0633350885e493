/// The verb medial: from the atoms of a medial model to the surface through their spokes' ends.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "batten/medial/medial_check.h"
#include "batten/medial/medial_io.h"
#include "batten/medial/medial_refinement.h"
#include "batten/medial/medial_surface.h"
#include "batten/medial/spoke_mesh.h"
#include "batten/refine/spread_numbers.h"
#include "cli/interpolation_rows.h"
#include "cli/job.h"
#include "cli/normals.h"
#include "cli/picture.h"
#include "cli/surface_output.h"

namespace batten::cli {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// A medial model and all that was made of it.
struct MedialRun {
  const MedialArguments& arguments;
  const MedialModel& model;
  const MedialSurface& made;
  SpokeCheck check;
  Topology solved;                   ///< of the control mesh before normals were turned
  std::optional<TurnReport> turned;  ///< with --normals
};

std::string name_at(const MedialRun& run, Index vertex) {
  return spoke_name(run.model, run.made.boundary.ends[static_cast<std::size_t>(vertex)]);
}

std::string model_text(const MedialModel& model) {
  std::int64_t atoms = 0;
  for (const MedialFigure& figure : model.figures) atoms += figure.atom_count();
  std::string text = count_of(atoms, "atom", "atoms");
  if (model.figures.size() > 1)
    text += " in " + count_of(static_cast<std::int64_t>(model.figures.size()), "figure", "figures");
  if (const auto& grid = model.figures.front().grid)
    text += fmt::format(": {} lines, {}", grid->crest_points, count_of(grid->steps, "step", "steps"));
  return text;
}

/// The spokes whose ends a hinge has taken off the surface.
std::int64_t left_out(const MedialRun& run) {
  std::int64_t all = 0;
  for (const MedialFigure& figure : run.model.figures)
    all += 2 * std::int64_t{figure.atom_count()} + static_cast<std::int64_t>(figure.crest.size());
  return all - run.made.boundary.mesh.vertex_count();
}

void add_check_rows(const MedialRun& run, Table& table) {
  const Scalars& radii = run.made.boundary.radii;
  table.add("spokes",
            fmt::format("{}, {:.4g} to {:.4g} long", grouped(radii.size()), radii.minCoeff(), radii.maxCoeff()));
  if (const std::int64_t inside = left_out(run); inside > 0)
    table.add("", count_of(inside, "spoke ends", "spokes end") + " inside, where hinges open the boundary");
  const SpokeCheck& check = run.check;
  table.add("Blum", fmt::format("spokes lean by at most {:.3g} degrees (mean {:.3g}), {}", kDegrees * check.max_tilt,
                                kDegrees * check.mean_tilt, name_at(run, check.tilt_vertex)));
  table.add("", fmt::format("an atom's lengths differ by at most {:.3g} % (mean {:.3g} %)",
                            100.0 * check.max_length_difference, 100.0 * check.mean_length_difference));
  if (check.crossings.empty()) return;
  const SpokeCrossing& first = check.crossings.front();
  table.add("crossing", fmt::format("{} of neighbouring spokes pass each other: {} and {}",
                                    count_of(static_cast<std::int64_t>(check.crossings.size()), "pair", "pairs"),
                                    name_at(run, first.first), name_at(run, first.second)));
}

void add_error_rows(const MedialRun& run, Table& table) {
  const MedialErrors& errors = run.made.errors;
  const auto where = [&](const VertexMeasure& measure) {
    return measure.worst_vertex < 0 ? std::string("no spoke") : name_at(run, measure.worst_vertex);
  };
  table.add("distance", fmt::format("at most {:.3g} ({:.3g} of the radius), {}", errors.distance.max,
                                    errors.distance_share.max, where(errors.distance_share)));
  table.add("angle", fmt::format("at most {:.3g} degrees between spoke and normal (mean {:.3g}), {}",
                                 kDegrees * errors.angle.max, kDegrees * errors.angle.mean, where(errors.angle)));
  table.add("shift", fmt::format("at most {:.3g} of the radius between atom and fitted atom (mean {:.3g}), {}",
                                 errors.shift.max, errors.shift.mean, where(errors.shift)));
}

nlohmann::ordered_json measure_json(const MedialRun& run, const VertexMeasure& measure, double unit = 1.0) {
  nlohmann::ordered_json json{{"max", unit * measure.max}, {"mean", unit * measure.mean}, {"rms", unit * measure.rms}};
  json["at"] = measure.worst_vertex < 0 ? "" : name_at(run, measure.worst_vertex);
  json["vertex"] = measure.worst_vertex;
  return json;
}

nlohmann::ordered_json figures_json(const MedialModel& model) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const MedialFigure& figure : model.figures) {
    nlohmann::ordered_json one{{"name", figure.name}, {"atoms", figure.atom_count()}, {"crest", figure.crest.size()}};
    if (figure.grid) {
      one["crest_points"] = figure.grid->crest_points;
      one["steps"] = figure.grid->steps;
    }
    json.push_back(std::move(one));
  }
  return json;
}

nlohmann::ordered_json report_json(const MedialRun& run) {
  const MedialErrors& errors = run.made.errors;
  const SpokeCheck& check = run.check;
  nlohmann::ordered_json crossings = nlohmann::ordered_json::array();
  for (const SpokeCrossing& crossing : check.crossings)
    crossings.push_back({name_at(run, crossing.first), name_at(run, crossing.second)});
  return {{"figures", figures_json(run.model)},
          {"vertices", run.made.boundary.mesh.vertex_count()},
          {"faces", run.made.boundary.mesh.face_count()},
          {"left_out", left_out(run)},
          {"converged", run.made.surface.converged()},
          {"crossings", crossings},
          {"blum",
           {{"max_tilt", kDegrees * check.max_tilt},
            {"mean_tilt", kDegrees * check.mean_tilt},
            {"tilt_at", name_at(run, check.tilt_vertex)},
            {"max_length_difference", check.max_length_difference},
            {"mean_length_difference", check.mean_length_difference}}},
          {"distance", measure_json(run, errors.distance)},
          {"distance_share", measure_json(run, errors.distance_share)},
          {"angle", measure_json(run, errors.angle, kDegrees)},
          {"shift", measure_json(run, errors.shift)}};
}

void add_losses(Job& job, const std::vector<std::string>& losses) {
  job.lost.insert(job.lost.end(), losses.begin(), losses.end());
}

void write_sheet(const MedialRun& run, Table& table, Job& job) {
  const MedialArguments& arguments = run.arguments;
  if (arguments.sheet.empty() && arguments.model.empty()) return;
  const MedialModel refined = refine_medial(run.model, arguments.sheet_levels);
  if (!arguments.sheet.empty()) {
    CommonArguments sheet = arguments.common;
    sheet.output = arguments.sheet;
    sheet.output_format.clear();
    sheet.ascii = false;
    const Mesh mesh = sheet_mesh(refined);
    write_output(sheet, mesh, job.up);
    add_losses(job, tell_losses(sheet, mesh));
  }
  if (!arguments.model.empty()) {
    write_medial(arguments.model, refined);
    const std::vector<std::string> losses = find_medial_losses(arguments.model, refined);
    say_losses(arguments.model, losses, arguments.common.quiet);
    add_losses(job, losses);
  }
  table.add("sheet", model_text(refined));
  job.stages.finish("sheet");
}

/// The numbers at the vertices that the colours show, and what they are.
Scalars shown_numbers(const MedialRun& run, MedialColoring coloring, ScaleRequest& scale) {
  const MedialErrors& errors = run.made.errors;
  switch (coloring) {
    case MedialColoring::Angle:
      scale = {"spoke to normal", "degrees", ColorMap::Sequential};
      return kDegrees * errors.angles;
    case MedialColoring::Distance:
      scale = {"distance", "of the radius", ColorMap::Sequential};
      return errors.distances.cwiseQuotient(run.made.boundary.radii);
    case MedialColoring::Shift:
      scale = {"shift of the atom", "of the radius", ColorMap::Sequential};
      return errors.shifts;
    case MedialColoring::Radius:
      break;
  }
  scale = {"radius", "in the model's unit", ColorMap::Sequential};
  return run.made.boundary.radii;
}

/// The surface in colours; before it, if asked for, the model itself.
void draw_surface(const MedialRun& run, Job& job) {
  PictureArguments picture = run.arguments.picture;
  const InterpolatedMesh& surface = run.made.surface;
  Subject after;
  after.control = &surface.mesh;
  after.topology = surface.topology;
  after.scheme = surface.scheme;
  after.levels = run.arguments.levels;
  after.after_caption = picture.before_after ? "the surface" : "";
  if (run.arguments.coloring) {
    const Scalars numbers = shown_numbers(run, *run.arguments.coloring, after.numbers_scale);
    after.numbers = spread_numbers(numbers, run.solved, surface.scheme.kind, surface.topology.vertex_count());
  }
  std::vector<Subject> subjects;
  const Mesh spokes = picture.before_after ? spoke_mesh(run.model) : Mesh();
  if (picture.before_after) {
    Subject before;
    before.control = &spokes;
    before.flat = true;
    before.after_caption = "the atoms and their spokes";
    subjects.push_back(std::move(before));
  }
  subjects.push_back(std::move(after));
  draw_row(subjects, picture, job);
  job.stages.finish("picture");
}

}  // namespace

int run_medial(const MedialArguments& arguments) {
  const CommonArguments& common = arguments.common;
  MedialModel model;
  const auto read = [&] { model = read_medial(common.input, ProgressBar("reading", common.quiet).callback()); };
  Job job("medial", common, read, UpAxis::Z);
  if (!arguments.model.empty()) require_medial_format(arguments.model, model);
  MedialSurface made =
      medial_surface(model, medial_interpolation(), ProgressBar("interpolating", common.quiet).callback());
  MedialRun run{arguments, model, made, check_spokes(made.boundary), made.surface.topology, {}};
  job.stages.finish("solve");
  if (arguments.normals) {
    run.turned = turn_to_spokes(made, turn_options(arguments.normal_tolerance),
                                ProgressBar("turning normals", common.quiet).callback());
    job.stages.finish("normals");
  }
  Table table;
  table.add("model", model_text(model));
  table.add("mesh", size_text(made.boundary.mesh));
  add_check_rows(run, table);
  add_error_rows(run, table);
  if (run.turned) {
    table.add("before", fmt::format("at most {:.3g} degrees between spoke and normal before they turned (mean {:.3g})",
                                    kDegrees * run.turned->before_angle.max, kDegrees * run.turned->before_angle.mean));
    add_normal_rows(*run.turned, table);
  }
  const InterpolatedMesh& surface = made.surface;
  const std::string written = write_surface({surface.mesh, surface.topology, surface.scheme}, arguments.levels, job);
  if (!written.empty()) table.add("written", written);
  write_sheet(run, table, job);
  if (!arguments.picture.path.empty()) draw_surface(run, job);
  job.print(table);
  nlohmann::ordered_json report = report_json(run);
  if (run.turned) report["normals"] = normals_json(*run.turned);
  job.report(report);
  require_reached(surface.reports, medial_interpolation().tolerance);
  return 0;
}

}  // namespace batten::cli
