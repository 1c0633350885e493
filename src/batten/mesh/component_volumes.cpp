#include "batten/mesh/component_volumes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <utility>

#include "batten/parallel/parallel.h"

namespace batten {

namespace {

double face_volume(const Topology& topology, ConstValuesRef points, Index base, Index f) {
  const Eigen::RowVector3d origin = points.row(base);
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (Index h = topology.face_begin(f); h < topology.face_end(f); ++h) {
    const Eigen::Vector3d a = (points.row(topology.origin(h)) - origin).transpose();
    const Eigen::Vector3d b = (points.row(topology.destination(h)) - origin).transpose();
    centre += a;
    normal += a.cross(b);
  }
  return centre.dot(normal) / (6.0 * topology.face_size(f));
}

}  // namespace

Index ComponentVolumes::closed_count() const { return static_cast<Index>(std::count(closed.begin(), closed.end(), 1)); }
double ComponentVolumes::sum() const { return std::accumulate(volumes.begin(), volumes.end(), 0.0); }

ComponentVolumes component_volumes(const Topology& topology, ConstValuesRef points) {
  return component_volumes(topology, points, connected_components(topology));
}

ComponentVolumes component_volumes(const Topology& topology, ConstValuesRef points, Components components) {
  require_vertex_rows(topology, points);
  ComponentVolumes result{std::move(components), {}, {}};
  const auto count = static_cast<std::size_t>(result.components.count);
  result.closed.assign(count, 1);
  result.volumes.assign(count, 0.0);
  const Buffer<Index>& of_vertex = result.components.of_vertex;
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (topology.is_isolated(v) || topology.is_boundary_vertex(v)) result.closed[of_vertex[v]] = 0;
  }
  // Volumes are computed about each component's first vertex, so that a mesh far from the origin loses no digits.
  std::vector<Index> first(count, -1);
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (first[of_vertex[v]] < 0) first[of_vertex[v]] = v;
  }
  const auto component_of = [&](Index f) { return of_vertex[topology.origin(topology.face_begin(f))]; };
  Buffer<double> volumes(static_cast<std::size_t>(topology.face_count()));
  parallel_for(topology.face_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      const Index component = component_of(f);
      volumes[f] = result.closed[component] == 0 ? 0.0 : face_volume(topology, points, first[component], f);
    }
  });
  for (Index f = 0; f < topology.face_count(); ++f) result.volumes[component_of(f)] += volumes[f];
  return result;
}

}  // namespace batten
