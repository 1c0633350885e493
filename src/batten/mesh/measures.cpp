#include "batten/mesh/measures.h"

#include <algorithm>
#include <limits>

#include "batten/mesh/face_triangles.h"
#include "batten/parallel/parallel.h"

namespace batten {

BoundingBox bounding_box(const Points& points) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  BoundingBox none;
  none.low.setConstant(kFar);
  none.high.setConstant(-kFar);
  const BoundingBox box = parallel_reduce(
      points.rows(), none,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        BoundingBox part = none;
        for (std::ptrdiff_t i = begin; i < end; ++i) {
          const Eigen::RowVector3d point = points.row(i);
          if (!point.allFinite()) continue;
          part.low = part.low.cwiseMin(point);
          part.high = part.high.cwiseMax(point);
        }
        return part;
      },
      [](const BoundingBox& a, const BoundingBox& b) {
        return BoundingBox{a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)};
      });
  return box.low[0] <= box.high[0] ? box : BoundingBox();
}

EdgeLengths edge_lengths(const Topology& topology, ConstValuesRef points) {
  require_vertex_rows(topology, points);
  if (topology.edge_count() == 0) return {};
  const EdgeLengths none{std::numeric_limits<double>::infinity(), 0.0, 0.0};
  EdgeLengths lengths = parallel_reduce(
      topology.edge_count(), none,
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        EdgeLengths part = none;
        for (auto e = static_cast<Index>(begin); e < end; ++e) {
          const Index h = topology.edge_half_edge(e);
          const Eigen::RowVector3d edge = points.row(topology.origin(h)) - points.row(topology.destination(h));
          const double length = edge.stableNorm();
          part.shortest = std::min(part.shortest, length);
          part.mean += length;
          part.longest = std::max(part.longest, length);
        }
        return part;
      },
      [](const EdgeLengths& a, const EdgeLengths& b) {
        return EdgeLengths{std::min(a.shortest, b.shortest), a.mean + b.mean, std::max(a.longest, b.longest)};
      });
  lengths.mean /= topology.edge_count();
  return lengths;
}

double surface_area(const Topology& topology, ConstValuesRef points) {
  require_vertex_rows(topology, points);
  const FaceTriangles triangles(topology, points);
  const auto corner = [&](Index v) -> Eigen::Vector3d { return points.row(v).transpose(); };
  const auto areas = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    double sum = 0.0;
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      for (Index k = 0; k + 2 < topology.face_size(f); ++k) {
        const std::array<Index, 3> triangle = triangles.vertices(f, k);
        const Eigen::Vector3d origin = corner(triangle[0]);
        sum += (corner(triangle[1]) - origin).cross(corner(triangle[2]) - origin).norm();
      }
    }
    return sum;
  };
  return 0.5 * parallel_reduce(topology.face_count(), 0.0, areas, [](double a, double b) { return a + b; });
}

}  // namespace batten
