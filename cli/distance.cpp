/// How far a scan's points lie from a limit surface.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "batten/error.h"
#include "batten/io/io.h"
#include "batten/nearest/surface_side.h"
#include "batten/parallel/parallel.h"
#include "cli/distance_summary.h"
#include "cli/job.h"
#include "cli/picture.h"

namespace batten::cli {
namespace {

/// What was measured.
struct Measured {
  std::vector<NearestPoint> nearest;
  Scalars distances;  ///< negative inside of a closed surface
  bool closed = false;
  double diagonal = 0.0;   ///< of the surface
  double tolerance = 0.0;  ///< of each distance
};

Measured measure(const Topology& topology, const Scheme& scheme, const Mesh& control, const Points& points,
                 bool quiet) {
  ProgressBar building("building", quiet);
  const NearestPoints nearest(topology, scheme, control.points, building.callback());
  Measured measured;
  measured.diagonal = nearest.diagonal();
  measured.tolerance = nearest.tolerance();
  measured.nearest.resize(static_cast<std::size_t>(points.rows()));
  ProgressBar measuring("measuring", quiet);
  nearest.nearest(points, measured.nearest, measuring.callback());
  measured.closed = encloses_space(topology);
  const LimitSurface surface(topology, scheme, control.points);
  measured.distances.resize(points.rows());
  parallel_for(points.rows(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (std::ptrdiff_t i = begin; i < end; ++i) {
      const NearestPoint& found = measured.nearest[static_cast<std::size_t>(i)];
      const bool apart = found.distance > measured.tolerance;  // else the point is on the surface
      const bool inside =
          measured.closed && apart && side_of(surface, points.row(i).transpose(), found) == SurfaceSide::Inside;
      measured.distances[i] = inside ? -found.distance : found.distance;
    }
  });
  return measured;
}

/// The points that are farthest away, the farthest first.
std::vector<Index> farthest(const Scalars& distances, std::size_t most) {
  std::vector<Index> points(static_cast<std::size_t>(distances.size()));
  std::iota(points.begin(), points.end(), 0);
  most = std::min(most, points.size());
  const auto farther = [&](Index a, Index b) {
    const double x = std::abs(distances[a]);
    const double y = std::abs(distances[b]);
    return x != y ? x > y : a < b;
  };
  std::partial_sort(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(most), points.end(), farther);
  points.resize(most);
  return points;
}

nlohmann::ordered_json points_json(const Measured& measured, const std::vector<Index>& points) {
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

nlohmann::ordered_json report_json(const DistanceArguments& arguments, const Measured& measured,
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
          {"points_inside", summary.inside_count},
          {"histogram", histogram_json(histogram)},
          {"farthest", points_json(measured, farthest(measured.distances, 10))}};
}

/// At most so many: half of them the farthest, the others spread over all. In ascending order.
std::vector<Index> drawn_points(const Scalars& distances, Index most) {
  const auto count = static_cast<Index>(distances.size());
  std::vector<Index> drawn(static_cast<std::size_t>(count));
  std::iota(drawn.begin(), drawn.end(), 0);
  if (count <= most) return drawn;
  drawn = farthest(distances, static_cast<std::size_t>(most / 2));
  const double stride = 2.0 * count / most;
  for (Index i = 0; i < most / 2; ++i) drawn.push_back(static_cast<Index>(stride * i));
  std::sort(drawn.begin(), drawn.end());
  drawn.erase(std::unique(drawn.begin(), drawn.end()), drawn.end());
  return drawn;
}

/// A scan with faces shows the distances itself; points are drawn where they meet the surface, so that those inside
/// are seen too.
void draw_distances(const DistanceArguments& arguments, const Mesh& scan, const Mesh& control, const Scheme& scheme,
                    const Measured& measured) {
  constexpr Index kMostMarkers = 20000;
  Subject subject;
  subject.before = control;
  subject.before_caption = "the control mesh";
  subject.after_caption = "the distances";
  subject.numbers_scale.title = measured.closed ? "distance, inside < 0" : "distance";
  subject.numbers_scale.unit = "in the mesh's unit";
  subject.numbers_scale.map = measured.closed ? ColorMap::Diverging : ColorMap::Sequential;
  if (scan.face_count() > 0) {
    subject.control = scan;
    subject.flat = true;
    subject.numbers = measured.distances;
  } else {
    subject.control = control;
    subject.scheme = scheme;
    const std::vector<Index> drawn = drawn_points(measured.distances, kMostMarkers);
    subject.numbers = measured.distances(drawn);
    subject.markers.resize(subject.numbers.size(), 3);
    for (Eigen::Index i = 0; i < subject.markers.rows(); ++i) {
      const Index point = drawn[static_cast<std::size_t>(i)];
      subject.markers.row(i) = measured.nearest[static_cast<std::size_t>(point)].point.transpose();
    }
    // About a third of the distance between points that are spread evenly.
    const double count = static_cast<double>(drawn.size());
    subject.marker_radius = measured.diagonal * std::min(0.25 / std::sqrt(count), 0.012);
  }
  draw(subject, arguments.picture, arguments.common.quiet);
}

void write_distances(const CommonArguments& common, Mesh scan, const Scalars& distances) {
  if (common.output.empty()) return;
  std::erase_if(scan.attributes, [](const Attribute& attribute) { return attribute.name == "distance"; });
  scan.attributes.push_back({"distance", distances, {}});
  write_output(common, scan);
}

void print_table(const Topology& topology, const Scheme& scheme, const Measured& measured,
                 const DistanceSummary& summary, const Histogram& histogram, const Job& job) {
  Table table;
  const auto part = [&](double distance) { return measured.diagonal > 0.0 ? distance / measured.diagonal : 0.0; };
  table.add("scan", count_of(measured.distances.size(), "point", "points"));
  table.add("surface", mesh_text(topology));
  table.add("scheme", scheme_text(scheme));
  table.add("max", fmt::format("{:.4g} at point {} ({:.3g} of the diagonal)", summary.max, summary.max_point,
                               part(summary.max)));
  if (measured.closed) {
    table.add("outside", fmt::format("at most {:.4g}, {}", summary.most_outside,
                                     count_of(measured.distances.size() - summary.inside_count, "point", "points")));
    table.add("inside", fmt::format("at most {:.4g}, {}", summary.most_inside,
                                    count_of(summary.inside_count, "point", "points")));
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
  const Mesh scan = read_mesh(arguments.scan, "", ProgressBar("reading", common.quiet).callback());
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
  const Measured measured = measure(topology, scheme, control, scan.points, common.quiet);
  const DistanceSummary summary = summarize(measured.distances);
  const Histogram histogram = histogram_of(measured.distances);
  job.stages.finish("measure");
  write_distances(common, scan, measured.distances);
  job.stages.finish("write");
  if (!arguments.picture.path.empty()) {
    draw_distances(arguments, scan, control, scheme, measured);
    job.stages.finish("picture");
  }
  print_table(topology, scheme, measured, summary, histogram, job);
  job.report(report_json(arguments, measured, summary, histogram, scheme));
  return 0;
}

}  // namespace batten::cli
