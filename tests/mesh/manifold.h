/// \file An independent and slow test of whether a mesh is an oriented 2-manifold, by maps of edges without Topology.
#pragma once
#include <Eigen/Geometry>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "batten/mesh/mesh.h"

namespace batten::test {

struct ManifoldReport {
  bool valid = false;  ///< each directed edge once, a single fan at each vertex, no vertex unused
  std::string reason;  ///< empty if valid
  Index edge_count = 0;
  Index boundary_edge_count = 0;
  Index boundary_loop_count = 0;
  Index component_count = 0;
  double volume = 0.0;  ///< signed; positive where faces are counter-clockwise seen from outside
  Index euler = 0;      ///< V - E + F
};

using Edge = std::pair<Index, Index>;

/// The corners of each vertex as (vertex before, vertex after) in face order.
inline std::map<Index, std::map<Index, Index>> fans_of(const Mesh& mesh) {
  std::map<Index, std::map<Index, Index>> fans;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Index begin = mesh.face_offsets[f];
    const Index size = mesh.face_size(f);
    for (Index c = 0; c < size; ++c) {
      const Index before = mesh.face_vertices[begin + (c + size - 1) % size];
      fans[mesh.face_vertices[begin + c]][mesh.face_vertices[begin + (c + 1) % size]] = before;
    }
  }
  return fans;
}

/// True for one fan: turning from face to face visits every face. An open fan starts at a face without a predecessor.
inline bool is_single_fan(const std::map<Index, Index>& turns) {
  std::set<Index> reached;
  for (const auto& turn : turns) reached.insert(turn.second);
  Index start = turns.begin()->first;
  for (const auto& turn : turns) {
    if (reached.count(turn.first) == 0) start = turn.first;
  }
  std::size_t count = 0;
  for (Index at = start; count < turns.size();) {
    const auto found = turns.find(at);
    if (found == turns.end()) break;
    ++count;
    at = found->second;
    if (at == start) break;
  }
  return count == turns.size();
}

inline Index loop_count(const std::map<Index, Index>& next) {
  std::set<Index> seen;
  Index loops = 0;
  for (const auto& step : next) {
    if (seen.count(step.first) != 0) continue;
    ++loops;
    for (Index at = step.first; seen.insert(at).second;) at = next.at(at);
  }
  return loops;
}

inline double signed_volume(const Mesh& mesh) {
  double volume = 0.0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Index* vertices = mesh.face_vertices.data() + mesh.face_offsets[f];
    const Eigen::Vector3d a = mesh.points.row(vertices[0]);
    for (Index c = 1; c + 1 < mesh.face_size(f); ++c) {
      const Eigen::Vector3d b = mesh.points.row(vertices[c]);
      const Eigen::Vector3d d = mesh.points.row(vertices[c + 1]);
      volume += a.dot(b.cross(d)) / 6.0;
    }
  }
  return volume;
}

inline Index component_count(const std::map<Index, std::map<Index, Index>>& fans) {
  std::set<Index> seen;
  Index components = 0;
  for (const auto& fan : fans) {
    if (seen.count(fan.first) != 0) continue;
    ++components;
    std::vector<Index> open{fan.first};
    while (!open.empty()) {
      const Index vertex = open.back();
      open.pop_back();
      if (!seen.insert(vertex).second) continue;
      for (const auto& turn : fans.at(vertex)) {
        open.push_back(turn.first);
        open.push_back(turn.second);
      }
    }
  }
  return components;
}

inline ManifoldReport examine(const Mesh& mesh) {
  ManifoldReport report;
  std::set<Edge> directed;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Index begin = mesh.face_offsets[f];
    const Index size = mesh.face_size(f);
    for (Index c = 0; c < size; ++c) {
      const Edge edge{mesh.face_vertices[begin + c], mesh.face_vertices[begin + (c + 1) % size]};
      if (edge.first == edge.second || !directed.insert(edge).second) {
        report.reason = "face " + std::to_string(f) + " repeats a directed edge";
        return report;
      }
    }
  }
  std::map<Index, Index> boundary;
  for (const Edge& edge : directed) {
    const bool inner = directed.count({edge.second, edge.first}) != 0;
    if (!inner) boundary[edge.second] = edge.first;
    if (!inner || edge.first < edge.second) ++report.edge_count;
    if (!inner) ++report.boundary_edge_count;
  }
  const auto fans = fans_of(mesh);
  for (const auto& fan : fans) {
    if (!is_single_fan(fan.second)) report.reason = "faces meet only in vertex " + std::to_string(fan.first);
  }
  if (static_cast<Index>(fans.size()) != mesh.vertex_count()) report.reason = "a vertex without a face";
  report.valid = report.reason.empty();
  if (!report.valid) return report;
  report.boundary_loop_count = loop_count(boundary);
  report.component_count = component_count(fans);
  report.volume = signed_volume(mesh);
  report.euler = mesh.vertex_count() - report.edge_count + mesh.face_count();
  return report;
}

}  // namespace batten::test
