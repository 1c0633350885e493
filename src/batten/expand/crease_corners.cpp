#include "batten/expand/crease_corners.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "batten/mesh/face_normal.h"

namespace batten {

namespace {

Buffer<std::uint8_t> sharp_counts(const Topology& topology) {
  constexpr std::uint8_t kMany = 3;
  Buffer<std::uint8_t> counts(static_cast<std::size_t>(topology.vertex_count()), 0);
  for (Index e = 0; e < topology.edge_count(); ++e) {
    if (!(topology.edge_sharpness(e) > 0.0F)) continue;
    const Index h = topology.edge_half_edge(e);
    for (const Index v : {topology.origin(h), topology.destination(h)}) {
      if (counts[v] < kMany) ++counts[v];
    }
  }
  return counts;
}

/// The faces around the faces of a vertex that do not have it themselves, ascending.
std::vector<Index> second_ring(const Topology& topology, Index vertex) {
  std::vector<Index> inner;
  std::vector<Index> outer;
  topology.for_each_outgoing(vertex, [&](Index h) { inner.push_back(topology.face(h)); });
  for (const Index f : inner) {
    for (Index h = topology.face_begin(f); h < topology.face_end(f); ++h) {
      topology.for_each_outgoing(topology.origin(h), [&](Index out) { outer.push_back(topology.face(out)); });
    }
  }
  std::sort(outer.begin(), outer.end());
  outer.erase(std::unique(outer.begin(), outer.end()), outer.end());
  std::erase_if(outer, [&](Index f) { return std::find(inner.begin(), inner.end(), f) != inner.end(); });
  return outer;
}

}  // namespace

std::vector<Index> found_corners(const Topology& given, const Topology& creased) {
  constexpr std::uint8_t kMeet = 3;
  const Buffer<std::uint8_t> before = sharp_counts(given);
  const Buffer<std::uint8_t> now = sharp_counts(creased);
  std::vector<Index> corners;
  for (Index v = 0; v < creased.vertex_count(); ++v) {
    if (now[v] >= kMeet && before[v] < kMeet && !(given.vertex_sharpness(v) > 0.0F)) corners.push_back(v);
  }
  return corners;
}

Points corner_places(const Topology& topology, const std::vector<Index>& vertices, ConstValuesRef smoothed,
                     ConstValuesRef noisy, ConstValuesRef held, double most) {
  constexpr double kHold = 0.05;  // how strongly the place to hold counts
  Points places(static_cast<Eigen::Index>(vertices.size()), 3);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Eigen::Vector3d own = noisy.row(vertices[i]).transpose();
    const Eigen::Vector3d hold = held.row(vertices[i]).transpose();
    Eigen::Matrix3d planes = Eigen::Matrix3d::Zero();
    Eigen::Vector3d offsets = Eigen::Vector3d::Zero();
    double weight = 0.0;
    for (const Index f : second_ring(topology, vertices[i])) {
      const Eigen::Vector3d scaled = face_normal(topology, smoothed, f);
      const double area = scaled.norm();
      if (!(area > 0.0)) continue;
      const Eigen::Vector3d normal = scaled / area;
      Eigen::Vector3d centre = Eigen::Vector3d::Zero();
      for (Index h = topology.face_begin(f); h < topology.face_end(f); ++h) {
        centre += smoothed.row(topology.origin(h)).transpose();
      }
      centre /= topology.face_size(f);
      planes += area * normal * normal.transpose();
      offsets += area * normal.dot(centre - hold) * normal;
      weight += area;
    }
    Eigen::Vector3d moved = Eigen::Vector3d::Zero();
    if (weight > 0.0) moved = (planes + kHold * weight * Eigen::Matrix3d::Identity()).ldlt().solve(offsets);
    const Eigen::Vector3d place = hold + moved;
    places.row(static_cast<Eigen::Index>(i)) = ((place - own).norm() <= most ? place : own).transpose();
  }
  return places;
}

}  // namespace batten
