/// The verb distance: tells how far the points of a scan lie from a limit surface.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "batten/error.h"
#include "batten/io/io.h"
#include "batten/nearest/distance_summary.h"
#include "batten/nearest/surface_distances.h"
#include "cli/histogram.h"
#include "cli/job.h"
#include "cli/picture.h"

namespace batten::cli {
namespace {

nlohmann::ordered_json points_json(const SurfaceDistances& measured, const std::vector<Index>& points) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const Index i : points) {
    const NearestPoint& found = measured.nearest[static_cast<std::size_t>(i)];
    json.push_back({{"point", i},
                    {"distance", measured.distances[i]},
                    {"nearest", {found.point[0], found.point[1], found.point[2]}},
                    {"face", found.place.face},
                    {"u", found.place.u},
                    {"v", found.place.v}});
  }
  return json;
}

nlohmann::ordered_json report_json(const DistanceArguments& arguments, const SurfaceDistances& measured,
                                   const DistanceSummary& summary, const Histogram& histogram, const Scheme& scheme) {
  return {{"scan", arguments.scan},
          {"surface", arguments.common.input},
          {"points", measured.distances.size()},
          {"scheme", scheme_json(scheme)},
          {"diagonal", measured.diagonal},
          {"tolerance", measured.tolerance},
          {"signed", measured.closed},
          {"max", summary.max},
          {"rms", summary.rms},
          {"mean", summary.mean},
          {"median", summary.median},
          {"percentile_95", summary.most_of_95},
          {"percentile_99", summary.most_of_99},
          {"max_outside", summary.most_outside},
          {"max_inside", summary.most_inside},
          {"points_outside", summary.outside_count},
          {"points_inside", summary.inside_count},
          {"points_on_surface", summary.on_count},
          {"histogram", histogram_json(histogram)},
          {"farthest", points_json(measured, farthest_points(measured.distances, 10))}};
}

/// A scan with faces shows the distances itself; points are drawn where they meet the surface, so that those inside
/// are seen too.
void draw_distances(const DistanceArguments& arguments, const Mesh& scan, const Mesh& control, const Topology& topology,
                    const Scheme& scheme, const SurfaceDistances& measured, Job& job) {
  constexpr Index kMostMarkers = 20000;
  Subject subject;
  subject.before = &control;
  subject.before_caption = "the control mesh";
  subject.after_caption = "the distances";
  subject.numbers_scale.title = measured.closed ? "distance, inside < 0" : "distance";
  subject.numbers_scale.unit = "in the mesh's unit";
  subject.numbers_scale.map = measured.closed ? ColorMap::Diverging : ColorMap::Sequential;
  if (scan.face_count() > 0) {
    subject.control = &scan;
    subject.flat = true;
    subject.numbers = measured.distances;
  } else {
    subject.control = &control;
    subject.topology = topology;
    subject.scheme = scheme;
    const std::vector<Index> drawn = sample_points(measured.distances, kMostMarkers);
    subject.numbers = measured.distances(drawn);
    subject.markers.resize(subject.numbers.size(), 3);
    for (Eigen::Index i = 0; i < subject.markers.rows(); ++i) {
      const Index point = drawn[static_cast<std::size_t>(i)];
      subject.markers.row(i) = measured.nearest[static_cast<std::size_t>(point)].point.transpose();
    }
    // The spheres' radius: about a third of the distance between points that are spread evenly.
    const double count = static_cast<double>(drawn.size());
    subject.marker_radius = measured.diagonal * std::min(0.25 / std::sqrt(count), 0.012);
  }
  draw(subject, arguments.picture, job);
}

void write_distances(Job& job, Mesh& scan, const Scalars& distances) {
  if (!job.common.output.empty()) {
    std::erase_if(scan.attributes, [](const Attribute& attribute) { return attribute.name == "distance"; });
    scan.attributes.push_back({"distance", distances, {}});
  }
  job.write(scan);
}

std::string side_text(double most, Index count) {
  return count > 0 ? fmt::format("at most {:.4g}, {}", most, count_of(count, "point", "points")) : "no point";
}

void print_table(const Topology& topology, const Scheme& scheme, const SurfaceDistances& measured,
                 const DistanceSummary& summary, const Histogram& histogram, const Job& job) {
  Table table;
  const auto part = [&](double distance) { return measured.diagonal > 0.0 ? distance / measured.diagonal : 0.0; };
  table.add("scan", count_of(measured.distances.size(), "point", "points"));
  table.add("surface", mesh_text(topology));
  table.add("scheme", scheme_text(scheme));
  table.add("max", fmt::format("{:.4g} at point {} ({:.3g} of the diagonal)", summary.max, summary.max_point,
                               part(summary.max)));
  if (measured.closed) {
    table.add("outside", side_text(summary.most_outside, summary.outside_count));
    table.add("inside", side_text(summary.most_inside, summary.inside_count));
  }
  if (summary.on_count > 0) {
    table.add("on it", fmt::format("{} within {:.2g}, which is 0 here", count_of(summary.on_count, "point", "points"),
                                   measured.tolerance));
  }
  table.add("rms", fmt::format("{:.4g} ({:.3g} of the diagonal)", summary.rms, part(summary.rms)));
  table.add("mean", fmt::format("{:.4g}, half of the points within {:.4g}, 95 % within {:.4g}, 99 % within {:.4g}",
                                summary.mean, summary.median, summary.most_of_95, summary.most_of_99));
  const std::vector<std::string> bars = histogram_lines(histogram);
  for (std::size_t i = 0; i < bars.size(); ++i) {
    table.add(i == 0 ? "histogram" : i == 1 && measured.closed ? "inside < 0" : "", bars[i]);
  }
  job.print(table);
}

}  // namespace

int run_distance(const DistanceArguments& arguments) {
  const CommonArguments& common = arguments.common;
  Job job("distance", common);
  const Mesh& control = job.mesh;
  Mesh scan = read_file(arguments.scan, "", common.quiet, &job.notes);
  if (scan.vertex_count() == 0)
    throw Error(ErrorCode::BadArgument, arguments.scan + ": there are no points to measure");
  job.stages.finish("read scan");
  if (control.face_count() == 0) {
    throw Error(
        ErrorCode::BadArgument,
        common.input + ": there are no faces, only points; the surface comes second: batten distance SCAN SURFACE");
  }
  const Topology topology = job.connect();
  const Scheme scheme = scheme_for(common, control);
  const SurfaceDistances measured = measure_distances(topology, scheme, control.points, scan.points,
                                                      ProgressBar("measuring", common.quiet).callback());
  const DistanceSummary summary = summarize_distances(measured.distances, measured.tolerance);
  const Histogram histogram = histogram_of(measured.distances);
  job.stages.finish("measure");
  write_distances(job, scan, measured.distances);
  if (!arguments.picture.path.empty()) {
    draw_distances(arguments, scan, control, topology, scheme, measured, job);
    job.stages.finish("picture");
  }
  print_table(topology, scheme, measured, summary, histogram, job);
  job.report(report_json(arguments, measured, summary, histogram, scheme));
  return 0;
}

}  // namespace batten::cli
