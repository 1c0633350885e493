/// The verb fit: from points to a subdivision surface.
#include "batten/fit/fit_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "batten/error.h"
#include "batten/fit/crease_counts.h"
#include "batten/fit/mesh_samples.h"
#include "batten/io/io.h"
#include "batten/refine/refinement.h"
#include "cli/fit_arguments.h"
#include "cli/job.h"
#include "cli/picture.h"
#include "cli/surface_output.h"

namespace batten::cli {
namespace {

FitOptions options_of(const FitArguments& arguments, const Mesh& points, Job& job) {
  FitOptions options;
  if (arguments.init == kInitSphere) options.start = FitStart::Sphere;
  if (arguments.init != kInitAuto && arguments.init != kInitSphere) {
    options.initial = read_file(arguments.init, "", arguments.common.quiet, &job.notes);
    if (options.initial->face_count() == 0)
      throw Error(ErrorCode::BadArgument,
                  arguments.init + ": there are no faces, only points; --init is a control mesh");
    try {
      Topology(*options.initial);
    } catch (const Error& error) {
      throw Error(ErrorCode::BadArgument, arguments.init + ": " + error.what() + " (or let batten repair do it)");
    }
    options.scheme = choose_scheme(*options.initial);
  }
  if (arguments.common.scheme) options.scheme.kind = *arguments.common.scheme;
  options.method = arguments.method;
  options.vertices = arguments.vertices;
  options.rounds = arguments.rounds.value_or(options.rounds);
  options.genus = arguments.genus;
  if (arguments.creases) options.creases = *arguments.creases;
  const auto in_unit = [&](const Length& length) {
    return length.value * (length.relative ? bounding_diagonal(points.points) : 1.0);
  };
  if (arguments.tolerance) options.tolerance = in_unit(*arguments.tolerance);
  if (arguments.bridge) options.bridge = in_unit(*arguments.bridge);
  return options;
}

std::string end_text(const FitReport& report) {
  switch (report.end) {
    case FitEnd::Tolerance:
      return "the tolerance is reached";
    case FitEnd::Budget:
      return "more rounds gain nothing with so many control points";
    case FitEnd::Rounds:
      return "the last round still gained";
    case FitEnd::Cancelled:
      break;
  }
  return "interrupted; this is the surface of the last whole round";
}

const char* end_word(FitEnd end) {
  constexpr const char* kWords[] = {"tolerance", "budget", "rounds", "cancelled"};
  return kWords[static_cast<int>(end)];
}

std::string distances_text(const DistanceSummary& summary, double diameter) {
  const auto share = [&](double length) { return 100.0 * length / diameter; };
  return fmt::format("max {:.4g} ({:.3g} %), rms {:.4g} ({:.3g} %), 95 % within {:.4g} ({:.3g} %)", summary.max,
                     share(summary.max), summary.rms, share(summary.rms), summary.most_of_95,
                     share(summary.most_of_95));
}

nlohmann::ordered_json summary_json(const DistanceSummary& summary, double diameter) {
  return {{"max", summary.max},
          {"max_percent", 100.0 * summary.max / diameter},
          {"worst", summary.max_point},
          {"rms", summary.rms},
          {"rms_percent", 100.0 * summary.rms / diameter},
          {"percentile_95", summary.most_of_95},
          {"percentile_95_percent", 100.0 * summary.most_of_95 / diameter}};
}

nlohmann::ordered_json rounds_json(const FitReport& report) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const FitRound& round : report.rounds) {
    json.push_back({{"vertices", round.vertices},
                    {"fairness", round.fairness},
                    {"max", round.max},
                    {"rms", round.rms},
                    {"objective_before", round.objective},
                    {"objective_after", round.after},
                    {"iterations", round.iterations},
                    {"seconds", round.seconds}});
  }
  return json;
}

nlohmann::ordered_json report_json(const FitResult& result) {
  const FitReport& report = result.report;
  const CreaseCounts creases = count_creases(result.topology);
  return {{"points", result.distances.size()},
          {"vertices", result.topology.vertex_count()},
          {"faces", result.topology.face_count()},
          {"scheme", scheme_json(result.scheme)},
          {"creases", {{"edges", creases.edges}, {"corners", creases.corners}, {"darts", creases.darts}}},
          {"diameter", report.diameter},
          {"point_spacing", report.spacing},
          {"outliers", report.outliers},
          {"points_to_surface", summary_json(report.to_surface, report.diameter)},
          {"surface_to_points", summary_json(report.to_points, report.diameter)},
          {"unsound_faces", report.unsound},
          {"end", end_word(report.end)},
          {"rounds", rounds_json(report)},
          {"peak_memory_bytes", peak_memory_bytes()}};
}

void print_table(const FitResult& result, const std::optional<Index>& vertices, const std::string& written,
                 const std::string& frames, const Job& job) {
  const FitReport& report = result.report;
  Table table;
  table.add("points", count_of(result.distances.size(), "point", "points"));
  if (report.outliers > 0) table.add("", count_of(report.outliers, "outlier", "outliers") + " left out");
  table.add("surface", mesh_text(result.topology));
  if (vertices && result.topology.vertex_count() > *vertices)
    table.add("", fmt::format("no mesh to start from has as few as the {} asked",
                              count_of(*vertices, "control point", "control points")));
  table.add("scheme", scheme_text(result.scheme));
  const CreaseCounts creases = count_creases(result.topology);
  if (creases.edges > 0)
    table.add("creases", fmt::format("{}, {}, {}", count_of(creases.edges, "sharp edge", "sharp edges"),
                                     count_of(creases.corners, "corner", "corners"),
                                     count_of(creases.darts, "end within the surface", "ends within the surface")));
  table.add("distance", distances_text(report.to_surface, report.diameter) + " from the points to the surface");
  table.add("", distances_text(report.to_points, report.diameter) + " from the surface to the points");
  table.add("", fmt::format("% are of the enclosing sphere's diameter, {:.4g}; points are {:.4g} apart",
                            report.diameter, report.spacing));
  if (report.unsound > 0)
    table.add("unsound", count_of(report.unsound, "face folds", "faces fold") + " over or pass through others");
  table.add("rounds", fmt::format("{}; {}", report.rounds.size(), end_text(report)));
  if (!written.empty()) table.add("written", written);
  if (!frames.empty()) table.add("frames", frames);
  job.print(table);
}

constexpr Index kMostMarkers = 20000;
constexpr Index kMarkersOfRounds = 3000;

/// Of so many points, so that they leave the surface to be seen.
double marker_radius(Eigen::Index count, const FitReport& report) {
  return report.diameter * std::min(0.15 / std::sqrt(static_cast<double>(count)), 0.008);
}

/// The surface with the points where they meet it, in the colours of their distances.
void draw_fit(const FitArguments& arguments, const FitResult& result, const Mesh& points, Job& job) {
  Subject subject;
  subject.control = &result.mesh;
  subject.topology = result.topology;
  subject.scheme = result.scheme;
  subject.draw_control = true;
  subject.numbers_scale = {"distance", "in the points' unit", ColorMap::Sequential};
  const std::vector<Index> drawn = sample_points(result.distances, kMostMarkers);
  subject.numbers = result.distances(drawn);
  subject.markers = points.points(drawn, Eigen::all);
  subject.marker_radius = marker_radius(subject.markers.rows(), result.report);
  draw(subject, arguments.picture, job);
  job.stages.finish("picture");
}

void write_residuals(const FitArguments& arguments, const FitResult& result, Mesh points) {
  if (arguments.residuals.empty()) return;
  points.attributes.push_back({"distance", result.distances, {}});
  write_mesh(arguments.residuals, points);
}

}  // namespace

int run_fit(const FitArguments& arguments) {
  const CommonArguments& common = arguments.common;
  Job job("fit", common);
  FitOptions options = options_of(arguments, job.mesh, job);
  Evolution evolution(arguments.evolution);
  options.watch = evolution.watcher();
  const Index vertices = std::max(options.vertices.value_or(0), options.initial ? options.initial->vertex_count() : 0);
  const PointCloud cloud = cloud_of_mesh(job.mesh, vertices);
  Mesh points;
  points.points = cloud.points;
  job.stages.finish("sample");
  ProgressBar bar("fitting", common.quiet);
  const FitResult result = fit_surface(cloud, options, bar.callback());
  job.stages.finish("fit");
  const std::string written = write_surface({result.mesh, result.topology, result.scheme}, -1, job);
  write_residuals(arguments, result, points);
  // Small and few, so that the surface is seen between them in a panel.
  const Points markers = points.points(sample_points(result.distances, kMarkersOfRounds), Eigen::all);
  const double radius = 0.5 * marker_radius(markers.rows(), result.report);
  if (arguments.evolution.moments) {
    evolution.draw_moments(arguments.picture, markers, radius, job);
    job.stages.finish("picture");
  } else if (!arguments.picture.path.empty()) {
    draw_fit(arguments, result, points, job);
  }
  const std::string frames = evolution.write(arguments.picture, markers, radius, job);
  print_table(result, arguments.vertices, written, frames, job);
  job.report(report_json(result));
  return 0;
}

}  // namespace batten::cli
