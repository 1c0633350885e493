#include "batten/expand/volume.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace batten {

Index restore_volumes(const MeshSeries& series, const ComponentVolumes& before, Points& points) {
  constexpr double kLeastShare = 0.5;
  const Topology& topology = series.topology();
  const ComponentVolumes now = component_volumes(topology, points);
  const Buffer<Index>& of_vertex = now.components.of_vertex;
  const auto count = static_cast<std::size_t>(now.components.count);
  std::vector<double> factors(count, 1.0);
  for (std::size_t i = 0; i < count; ++i) {
    if (now.closed[i] == 0) continue;
    const double share = now.volumes[i] / before.volumes[i];
    if (share > kLeastShare && std::isfinite(share)) factors[i] = std::cbrt(1.0 / share);
  }
  std::vector<Eigen::RowVector3d> centres(count, Eigen::RowVector3d::Zero());
  std::vector<double> weights(count, 0.0);
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    const Index i = of_vertex[v];
    if (series.is_kept(v) || series.limit_matrix().row_kind(v) == LimitRow::Fixed) factors[i] = 1.0;
    centres[i] += series.weight(v) * points.row(v);
    weights[i] += series.weight(v);
  }
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    const Index i = of_vertex[v];
    if (factors[i] == 1.0) continue;
    const Eigen::RowVector3d centre = centres[i] / weights[i];
    points.row(v) = centre + factors[i] * (points.row(v) - centre);
  }
  return static_cast<Index>(std::count_if(factors.begin(), factors.end(), [](double f) { return f != 1.0; }));
}

}  // namespace batten
