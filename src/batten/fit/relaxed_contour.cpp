#include "batten/fit/relaxed_contour.h"

#include <Eigen/Geometry>

#include "batten/mesh/topology.h"
#include "batten/parallel/parallel.h"

namespace batten {

namespace {

constexpr int kRelaxRounds = 8;
constexpr double kRelaxStep = 0.5;

/// The mean of the neighbours and the normal of the ring around a vertex.
struct RingMean {
  Eigen::RowVector3d mean = Eigen::RowVector3d::Zero();
  Eigen::RowVector3d normal = Eigen::RowVector3d::Zero();
};

RingMean ring_mean(const Topology& topology, const Points& points, Index vertex) {
  RingMean ring;
  Index count = 0;
  const Eigen::RowVector3d centre = points.row(vertex);
  topology.for_each_outgoing(vertex, [&](Index h) {
    const Eigen::RowVector3d next = points.row(topology.destination(h));
    const Eigen::RowVector3d before = points.row(topology.origin(topology.previous(h)));
    ring.mean += next;
    ring.normal += (next - centre).cross(before - centre);
    ++count;
  });
  ring.mean /= std::max<Index>(count, 1);
  const double length = ring.normal.norm();
  if (length > 0.0) ring.normal /= length;
  return ring;
}

}  // namespace

void relax_contour(Mesh& mesh, const CloudField& field) {
  const Topology topology(mesh);
  for (int round = 0; round < kRelaxRounds; ++round) {
    const Points before = mesh.points;
    const auto relax = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t v = begin; v < end; ++v) {
        const auto vertex = static_cast<Index>(v);
        if (topology.is_boundary_vertex(vertex)) continue;
        const RingMean ring = ring_mean(topology, before, vertex);
        Eigen::RowVector3d move = kRelaxStep * (ring.mean - before.row(v));
        move -= 0.7 * ring.normal * ring.normal.dot(move);
        mesh.points.row(v) = field.nearest_place(before.row(v) + move, ring.normal);
      }
    };
    parallel_for(mesh.points.rows(), relax, 64);
  }
}

}  // namespace batten
