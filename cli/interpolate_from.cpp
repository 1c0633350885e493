/// The verb interpolate with --from: a surface that is there already follows points that have moved.
#include "cli/interpolate_from.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "batten/error.h"
#include "batten/interpolate/interpolation_updates.h"
#include "batten/mesh/vertex_fields.h"
#include "cli/interpolation_rows.h"
#include "cli/job.h"
#include "cli/picture.h"
#include "cli/surface_output.h"

namespace batten::cli {
namespace {

/// A point counts as moved from so many times the tolerance on: files hold points that were met to it.
constexpr double kMovedTolerances = 100.0;

/// The points that the surface does not pass through yet.
struct MovedPoints {
  std::vector<Index> vertices;
  Points points;
  double farthest = 0.0;  ///< from the surface
};

/// What became of the surface.
struct Movement {
  MovedPoints moved;
  UpdateReport report;
  Scalars of_control;     ///< of each control point
  double diagonal = 0.0;  ///< of the points wanted
};

/// Throws Error(BadArgument) unless the control mesh is one of this model.
void require_same_faces(const Mesh& model, const Mesh& control, const InterpolateArguments& arguments) {
  if (model.points.rows() == control.points.rows() && model.face_offsets == control.face_offsets &&
      model.face_vertices == control.face_vertices) {
    return;
  }
  throw Error(ErrorCode::BadArgument,
              fmt::format("{} ({}) does not have the faces of {} ({}): --from takes the control mesh that batten "
                          "interpolate wrote for the model before its points moved",
                          arguments.from, size_text(control), arguments.common.input, size_text(model)));
}

MovedPoints find_moved(const Points& wanted, const Values& surface, double least,
                       const InterpolateArguments& arguments) {
  MovedPoints moved;
  for (Index v = 0; v < static_cast<Index>(wanted.rows()); ++v) {
    const double distance = (wanted.row(v) - surface.row(v)).norm();
    if (distance <= least) continue;
    moved.vertices.push_back(v);
    moved.farthest = std::max(moved.farthest, distance);
  }
  moved.points = wanted(moved.vertices, Eigen::all);
  if (2 * static_cast<Eigen::Index>(moved.vertices.size()) > wanted.rows()) {
    throw Error(ErrorCode::BadArgument,
                fmt::format("{} of {} points of {} do not lie on the surface of {}; where most points have moved, "
                            "interpolate without --from",
                            grouped(static_cast<std::int64_t>(moved.vertices.size())),
                            grouped(static_cast<std::int64_t>(wanted.rows())), arguments.common.input, arguments.from));
  }
  return moved;
}

/// Moves the control points of job.mesh.
Movement follow(const InterpolateArguments& arguments, const Topology& topology, const Scheme& scheme,
                const Points& wanted, Job& job) {
  const bool quiet = arguments.common.quiet;
  // Another mesh, refined once, would not be the one that --from names.
  InterpolateOptions options = arguments.options;
  options.on_singular = OnSingular::Refuse;
  const Interpolator interpolator(topology, scheme, options, ProgressBar("building", quiet).callback());
  job.stages.finish("build");
  InterpolationUpdates updates = InterpolationUpdates::from_control(interpolator, job.mesh.points);
  Movement movement;
  movement.diagonal = bounding_diagonal(wanted);
  movement.moved =
      find_moved(wanted, updates.targets(), kMovedTolerances * options.tolerance * movement.diagonal, arguments);
  const MovedPoints& moved = movement.moved;
  ProgressBar bar("solving", quiet);
  movement.report = arguments.rings
                        ? updates.update_within(*arguments.rings, moved.vertices, moved.points, bar.callback())
                        : updates.update(moved.vertices, moved.points, bar.callback());
  movement.of_control = (updates.control() - job.mesh.points).rowwise().norm();
  job.mesh.points = updates.control();
  job.stages.finish("solve");
  return movement;
}

std::string length_text(double length, double diagonal) {
  return fmt::format("{:.4g} ({})", length, share_text(length, diagonal));
}

void print_table(const InterpolateArguments& arguments, const Topology& topology, const Scheme& scheme,
                 const Movement& movement, const std::string& written, const Job& job) {
  const UpdateReport& report = movement.report;
  const double farthest = movement.of_control.maxCoeff();
  Table table;
  table.add("mesh", mesh_text(topology));
  table.add("scheme", scheme_text(scheme));
  table.add("points moved",
            fmt::format("{} of {}, at most {}", grouped(static_cast<std::int64_t>(movement.moved.vertices.size())),
                        grouped(topology.vertex_count()), length_text(movement.moved.farthest, movement.diagonal)));
  table.add(
      "control points",
      fmt::format("{} moved, at most {}{}", grouped(report.moved), length_text(farthest, movement.diagonal),
                  arguments.rings ? fmt::format(", within {}", count_of(*arguments.rings, "ring", "rings")) : ""));
  table.add("max error",
            length_text(report.max_error, movement.diagonal) + (arguments.rings ? ", at a moved point" : ""));
  if (report.missed > 0) {
    table.add("missed",
              fmt::format("{}, at most {} at vertex {}", count_of(report.missed, "other point", "other points"),
                          length_text(report.max_miss, movement.diagonal), report.worst_miss));
  }
  if (!written.empty()) table.add("written", written);
  job.print(table);
}

nlohmann::ordered_json report_json(const InterpolateArguments& arguments, const Topology& topology,
                                   const Scheme& scheme, const Movement& movement) {
  const UpdateReport& report = movement.report;
  nlohmann::ordered_json json{{"vertices", topology.vertex_count()},
                              {"faces", topology.face_count()},
                              {"edges", topology.edge_count()},
                              {"isolated_vertices", isolated_count(topology)},
                              {"diagonal", movement.diagonal},
                              {"scheme", scheme_json(scheme)},
                              {"tolerance", arguments.options.tolerance},
                              {"from", arguments.from},
                              {"rings", nullptr},
                              {"moved_points", movement.moved.vertices.size()},
                              {"max_point_movement", movement.moved.farthest},
                              {"moved_control_points", report.moved},
                              {"max_control_movement", movement.of_control.maxCoeff()},
                              {"is_local", report.is_local},
                              {"max_error", report.max_error},
                              {"missed_points", report.missed},
                              {"max_miss", report.max_miss},
                              {"worst_miss", nullptr},
                              {"peak_memory_bytes", peak_memory_bytes()}};
  if (arguments.rings) json["rings"] = *arguments.rings;
  if (report.missed > 0) json["worst_miss"] = report.worst_miss;
  return json;
}

/// The new surface, coloured by how far control points have moved unless other colours are asked for.
void draw_movement(const InterpolateArguments& arguments, const Topology& topology, const Scheme& scheme,
                   const Points& wanted, const Movement& movement, const Mesh& before, Job& job) {
  Subject subject;
  subject.control = &job.mesh;
  subject.topology = topology;
  subject.scheme = scheme;
  subject.targets = &wanted;
  subject.before = &before;
  subject.before_caption = "the control mesh before";
  subject.after_caption = "the surface after";
  if (arguments.picture.coloring == Coloring::None) {
    subject.numbers = movement.of_control;
    subject.numbers_scale.title = "control points moved by";
    subject.numbers_scale.unit = "in the mesh's unit";
    subject.numbers_scale.log = true;
    subject.numbers_scale.outliers = 0.0;
  }
  draw(subject, arguments.picture, job);
  job.stages.finish("picture");
}

}  // namespace

int run_interpolate_from(const InterpolateArguments& arguments) {
  const CommonArguments& common = arguments.common;
  Job job("interpolate", common);
  CommonArguments start = common;
  start.input = arguments.from;
  start.input_format.clear();
  Mesh control = read_input(start, nullptr, &job.notes);
  require_same_faces(job.mesh, control, arguments);
  const Points wanted = job.mesh.points;
  job.mesh = std::move(control);
  const Topology topology = job.connect();
  const Scheme scheme = scheme_for(common, job.mesh);
  const Mesh before = arguments.picture.path.empty() ? Mesh() : job.mesh;
  const Movement movement = follow(arguments, topology, scheme, wanted, job);
  const std::string written = write_surface({job.mesh, topology, scheme}, arguments.levels, job);
  if (!arguments.picture.path.empty()) draw_movement(arguments, topology, scheme, wanted, movement, before, job);
  print_table(arguments, topology, scheme, movement, written, job);
  job.report(report_json(arguments, topology, scheme, movement));
  if (movement.report.outcome == Outcome::NotReached) {
    throw Error(ErrorCode::NotConverged, fmt::format("the tolerance {:g} was not reached; what was reached is written",
                                                     arguments.options.tolerance));
  }
  return 0;
}

}  // namespace batten::cli
