#include "batten/fit/paired_quads.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "batten/fit/contour_parts.h"
#include "batten/fit/matching.h"
#include "batten/fit/quad_turns.h"
#include "batten/mesh/topology.h"

namespace batten {

namespace {

/// The corners of the two triangles at a half-edge, in a circle.
std::array<Index, 4> quad_across(const Topology& topology, Index h) {
  const Index twin = topology.twin(h);
  return {topology.origin(h), topology.origin(topology.previous(twin)), topology.destination(h),
          topology.origin(topology.previous(h))};
}

std::vector<MatchedPair> ranked_pairs(const Topology& topology, const Points& points) {
  std::vector<MatchedPair> pairs;
  for (Index e = 0; e < topology.edge_count(); ++e) {
    if (topology.is_boundary_edge(e)) continue;
    const Index h = topology.edge_half_edge(e);
    const Index a = topology.face(h);
    const Index b = topology.face(topology.twin(h));
    pairs.push_back({quad_badness(points, quad_across(topology, h).data()), std::min(a, b), std::max(a, b)});
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// Takes out inner vertices with two faces: these become one.
bool take_out_doublets(Mesh& mesh) {
  const Topology topology(mesh);
  Buffer<std::uint8_t> kept(static_cast<std::size_t>(mesh.face_count()), 1);
  Buffer<std::uint8_t> touched(static_cast<std::size_t>(mesh.face_count()), 0);
  bool any = false;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (topology.is_boundary_vertex(v) || topology.vertex_face_count(v) != 2) continue;
    const Index h = topology.vertex_half_edge(v);
    const Index first = topology.face(h);
    const Index second = topology.face(topology.twin(h));
    if (topology.face_size(first) != 4 || topology.face_size(second) != 4 || touched[first] != 0 ||
        touched[second] != 0)
      continue;
    // The corner of the second face across from v takes the place of v in the first. The second face runs from v along
    // the edge after the twin.
    const Index across = topology.destination(topology.next(topology.next(topology.twin(h))));
    const auto begin = mesh.face_vertices.begin() + topology.face_begin(first);
    if (std::find(begin, begin + 4, across) != begin + 4) continue;
    mesh.face_vertices[h] = across;
    kept[second] = 0;
    touched[first] = touched[second] = 1;
    any = true;
  }
  if (any) keep_faces(mesh, kept);
  return any;
}

}  // namespace

Mesh paired_quads(const Mesh& mesh) {
  const Topology topology(mesh);
  const std::vector<double> limits{0.3, 0.45, 0.6, 0.7, 0.8, 0.9, 1.0, 1.2};
  const std::vector<Index> partner = maximum_matching(mesh.face_count(), ranked_pairs(topology, mesh.points), limits);
  Mesh quads;
  quads.points = mesh.points;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (partner[f] < 0) {
      const Index h = topology.face_begin(f);
      quads.add_face({topology.origin(h), topology.origin(h + 1), topology.origin(h + 2)});
      continue;
    }
    if (partner[f] < f) continue;
    for (Index h = topology.face_begin(f); h < topology.face_end(f); ++h) {
      if (topology.twin(h) < 0 || topology.face(topology.twin(h)) != partner[f]) continue;
      const std::array<Index, 4> quad = quad_across(topology, h);
      quads.add_face({quad[0], quad[1], quad[2], quad[3]});
      break;
    }
  }
  while (take_out_doublets(quads)) {
  }
  return quads;
}

}  // namespace batten
