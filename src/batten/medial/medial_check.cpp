#include "batten/medial/medial_check.h"

#include <algorithm>
#include <cmath>

#include "batten/mesh/topology.h"

namespace batten {

namespace {

double tilt_of(const MedialBoundary& boundary, Index a, Index b) {
  const Eigen::RowVector3d chord = boundary.mesh.points.row(b) - boundary.mesh.points.row(a);
  const double length = chord.norm();
  if (!(length > 0.0)) return 0.0;
  const double along = 0.5 * (boundary.directions.row(a) + boundary.directions.row(b)).dot(chord);
  return std::asin(std::min(1.0, std::abs(along) / length));
}

bool pass_each_other(const MedialBoundary& boundary, Index a, Index b) {
  if (boundary.ends[static_cast<std::size_t>(a)].side != boundary.ends[static_cast<std::size_t>(b)].side) return false;
  const Eigen::RowVector3d at_start = boundary.origins.row(b) - boundary.origins.row(a);
  const Eigen::RowVector3d at_end = boundary.mesh.points.row(b) - boundary.mesh.points.row(a);
  return at_start.squaredNorm() > 0.0 && at_start.dot(at_end) <= 0.0;
}

void measure_edges(const MedialBoundary& boundary, SpokeCheck& found) {
  const Topology topology(boundary.mesh);
  double sum = 0.0;
  for (Index edge = 0; edge < topology.edge_count(); ++edge) {
    const Index h = topology.edge_half_edge(edge);
    const Index a = topology.origin(h);
    const Index b = topology.destination(h);
    if (pass_each_other(boundary, a, b)) found.crossings.push_back({std::min(a, b), std::max(a, b)});
    const double tilt = tilt_of(boundary, a, b);
    sum += tilt;
    if (found.tilt_vertex >= 0 && tilt <= found.max_tilt) continue;
    found.max_tilt = tilt;
    found.tilt_vertex = a;
  }
  found.mean_tilt = sum / std::max<Index>(1, topology.edge_count());
}

void measure_lengths(const MedialBoundary& boundary, SpokeCheck& found) {
  double sum = 0.0;
  Index count = 0;
  for (const auto& [up, down] : spoke_pairs(boundary)) {
    const double mean = 0.5 * (boundary.radii(up) + boundary.radii(down));
    const double difference = std::abs(boundary.radii(up) - boundary.radii(down)) / mean;
    sum += difference;
    ++count;
    if (found.length_vertex >= 0 && difference <= found.max_length_difference) continue;
    found.max_length_difference = difference;
    found.length_vertex = up;
  }
  found.mean_length_difference = sum / std::max<Index>(1, count);
}

}  // namespace

SpokeCheck check_spokes(const MedialBoundary& boundary) {
  SpokeCheck found;
  measure_edges(boundary, found);
  measure_lengths(boundary, found);
  return found;
}

}  // namespace batten
