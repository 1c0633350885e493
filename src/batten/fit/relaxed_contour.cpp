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

/// How far the faces around a vertex at `place` are from folding over: the least sine of a corner, negative where one
/// points against the normal.
double ring_quality(const Topology& topology, const Points& points, Index vertex, const Eigen::RowVector3d& place,
                    const Eigen::RowVector3d& normal) {
  double least = 1.0;
  const auto at = [&](Index h) -> Eigen::RowVector3d {
    return topology.origin(h) == vertex ? place : points.row(topology.origin(h));
  };
  topology.for_each_outgoing(vertex, [&](Index out) {
    for (const Index h : {topology.previous(out), out, topology.next(out)}) {
      const Eigen::RowVector3d next = at(topology.next(h)) - at(h);
      const Eigen::RowVector3d last = at(topology.previous(h)) - at(h);
      const double lengths = next.norm() * last.norm();
      least = std::min(least, lengths > 0.0 ? next.cross(last).dot(normal) / lengths : -1.0);
    }
  });
  return least;
}

/// `place`, or nearer to where the vertex is: faces that are close to folding over do not come closer.
Eigen::RowVector3d kept_open(const Topology& topology, const Points& points, Index vertex, Eigen::RowVector3d place,
                             const Eigen::RowVector3d& normal) {
  constexpr double kOpen = 0.3;
  Eigen::RowVector3d from = points.row(vertex);
  const double before = ring_quality(topology, points, vertex, from, normal);
  for (int halving = 0; halving < 3; ++halving) {
    const double after = ring_quality(topology, points, vertex, place, normal);
    if (after >= kOpen || after >= before) return place;
    place = 0.5 * (place + from);
  }
  return from;
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
  const Eigen::RowVector3d across =
      along.cross(ring.normal).normalized();  // away from the faces, which lie on the left
  const Eigen::RowVector3d place = field.nearest_place(0.5 * points.row(vertex) + 0.25 * (after + before), ring.normal);
  std::array<Index, kNear> near{};
  std::array<double, kNear> squares{};
  const Index found = field.tree.nearest(place, kNear, near.data(), squares.data());
  double farthest = -reach;
  for (Index k = 0; k < found; ++k) {
    const Eigen::RowVector3d step = field.samples.points.row(near[k]) - place;
    if (std::abs(step.dot(along)) < std::max(0.5 * reach, 1.5 * field.samples.spacing(near[k])))
      farthest = std::max(farthest, step.dot(across));
  }
  return kept_open(topology, points, vertex, place + across * std::clamp(farthest, -0.25 * reach, 0.25 * reach),
                   ring.normal);
}

/// Where an inner vertex goes: along the surface towards the mean of its neighbours, then to the samples.
Eigen::RowVector3d inner_place(const Topology& topology, const Points& points, const CloudField& field, Index vertex) {
  const RingMean ring = ring_mean(topology, points, vertex);
  Eigen::RowVector3d move = kRelaxStep * (ring.mean - points.row(vertex));
  move -= ring.normal * ring.normal.dot(move);
  return kept_open(topology, points, vertex, field.nearest_place(points.row(vertex) + move, ring.normal), ring.normal);
}

}  // namespace

void relax_contour(Mesh& mesh, const CloudField& field, int rounds) {
  constexpr int kBoundarySweeps = 4;
  const Topology topology(mesh);
  const double reach = edge_lengths(topology, mesh.points).mean;
  Buffer<std::uint8_t> creased(static_cast<std::size_t>(mesh.vertex_count()), 0);
  for (const Crease& crease : mesh.creases) creased[crease.a] = creased[crease.b] = 1;
  Points before;
  const auto sweep = [&](bool boundary) {
    before = mesh.points;
    const auto relax = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (auto vertex = static_cast<Index>(begin); vertex < end; ++vertex) {
        if (topology.is_boundary_vertex(vertex) != boundary || creased[vertex] != 0) continue;
        mesh.points.row(vertex) = boundary ? boundary_place(topology, before, field, vertex, reach)
                                           : inner_place(topology, before, field, vertex);
      }
    };
    parallel_for(mesh.points.rows(), relax, 64);
  };
  for (int round = 0; round < rounds; ++round) {
    for (int step = 0; step < kBoundarySweeps; ++step) sweep(true);
    sweep(false);
  }
}

}  // namespace batten
