#include "batten/fit/relaxed_contour.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "batten/mesh/measures.h"
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

/// Where a boundary vertex goes: along the boundary to the mean of its two neighbours, across it to where the samples
/// end, at most `reach` a round.
Eigen::RowVector3d boundary_place(const Topology& topology, const Points& points, const CloudField& field, Index vertex,
                                  double reach) {
  constexpr Index kNear = 24;
  const RingMean ring = ring_mean(topology, points, vertex);
  const Index out = topology.vertex_half_edge(vertex);
  Index in = out;
  topology.for_each_outgoing(vertex, [&](Index h) { in = topology.previous(h); });
  const Eigen::RowVector3d after = points.row(topology.destination(out));
  const Eigen::RowVector3d before = points.row(topology.origin(in));
  const Eigen::RowVector3d along = (after - before).normalized();
  const Eigen::RowVector3d across = along.cross(ring.normal).normalized();  // away from the faces, which lie on the left
  const Eigen::RowVector3d place = field.nearest_place(0.5 * points.row(vertex) + 0.25 * (after + before), ring.normal);
  std::array<Index, kNear> near{};
  std::array<double, kNear> squares{};
  const Index found = field.tree.nearest(place, kNear, near.data(), squares.data());
  double farthest = -reach;
  for (Index k = 0; k < found; ++k) {
    const Eigen::RowVector3d step = field.samples.points.row(near[k]) - place;
    if (std::abs(step.dot(along)) < std::max(0.5 * reach, 0.75 * field.samples.spacing(near[k])))
      farthest = std::max(farthest, step.dot(across));
  }
  return place + across * std::clamp(farthest, -0.25 * reach, 0.25 * reach);
}

}  // namespace

void relax_contour(Mesh& mesh, const CloudField& field) {
  const Topology topology(mesh);
  const double reach = edge_lengths(topology, mesh.points).mean;
  for (int round = 0; round < kRelaxRounds; ++round) {
    const Points before = mesh.points;
    const auto relax = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (std::ptrdiff_t v = begin; v < end; ++v) {
        const auto vertex = static_cast<Index>(v);
        if (topology.is_boundary_vertex(vertex)) {
          mesh.points.row(v) = boundary_place(topology, before, field, vertex, reach);
          continue;
        }
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
