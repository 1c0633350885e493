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
    if (topology.is_boundary_edge(e) || topology.edge_sharpness(e) > 0.0F) continue;
    const Index h = topology.edge_half_edge(e);
    const Index a = topology.face(h);
    const Index b = topology.face(topology.twin(h));
    pairs.push_back({quad_badness(points, quad_across(topology, h).data()), std::min(a, b), std::max(a, b)});
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// The part between creases that each face lies in.
std::vector<Index> regions_of(const Topology& topology, Index& count) {
  std::vector<Index> region(static_cast<std::size_t>(topology.face_count()), -1);
  count = 0;
  for (Index first = 0; first < topology.face_count(); ++first) {
    if (region[first] >= 0) continue;
    std::vector<Index> faces{first};
    region[first] = count;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      for (Index h = topology.face_begin(faces[i]); h < topology.face_end(faces[i]); ++h) {
        const Index twin = topology.twin(h);
        if (twin < 0 || topology.edge_sharpness(topology.edge(h)) > 0.0F || region[topology.face(twin)] >= 0) continue;
        region[topology.face(twin)] = count;
        faces.push_back(topology.face(twin));
      }
    }
    ++count;
  }
  return region;
}

/// The creases of a way from a region with an odd number of faces to the nearest other one, each crossed once; empty
/// where there is none.
std::vector<Index> way_to_odd(const Topology& topology, const std::vector<Index>& region,
                              const std::vector<Index>& sizes, Index from) {
  std::vector<Index> crossed(sizes.size(), -1);
  std::vector<Index> before(sizes.size(), -1);
  std::vector<Index> reached{from};
  before[from] = from;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (Index e = 0; e < topology.edge_count(); ++e) {
      if (topology.is_boundary_edge(e) || !(topology.edge_sharpness(e) > 0.0F)) continue;
      const Index h = topology.edge_half_edge(e);
      Index one = region[topology.face(h)];
      Index other = region[topology.face(topology.twin(h))];
      if (other == reached[i]) std::swap(one, other);
      if (one != reached[i] || before[other] >= 0) continue;
      before[other] = one;
      crossed[other] = e;
      reached.push_back(other);
      if (sizes[other] % 2 == 0) continue;
      std::vector<Index> way;
      for (Index at = other; at != from; at = before[at]) way.push_back(crossed[at]);
      return way;
    }
  }
  return {};
}

/// Halves a crease and the two triangles beside it.
void halve_crease(Mesh& mesh, Index a, Index b) {
  const Index middle = mesh.vertex_count();
  mesh.points.conservativeResize(middle + 1, 3);
  mesh.points.row(middle) = 0.5 * (mesh.points.row(a) + mesh.points.row(b));
  const Index faces = mesh.face_count();
  for (Index f = 0; f < faces; ++f) {
    Index* corners = mesh.face_vertices.data() + mesh.face_offsets[f];
    if (std::count(corners, corners + 3, a) + std::count(corners, corners + 3, b) != 2) continue;
    std::array<Index, 3> other{corners[0], corners[1], corners[2]};
    std::replace(corners, corners + 3, b, middle);
    std::replace(other.begin(), other.end(), a, middle);
    mesh.add_face({other[0], other[1], other[2]});
  }
  for (Crease& crease : mesh.creases) {
    if (std::minmax(crease.a, crease.b) != std::minmax(a, b)) continue;
    const double sharpness = crease.sharpness;
    crease = {a, middle, sharpness};
    mesh.creases.push_back({middle, b, sharpness});
    break;
  }
}

/// Triangles on both sides of a crease make no pair, so that each region between creases needs an even number of them:
/// creases between odd ones are halved, which adds a triangle on each side.
Mesh even_regions(Mesh mesh) {
  if (mesh.creases.empty()) return mesh;
  for (;;) {
    const Topology topology(mesh);
    Index count = 0;
    const std::vector<Index> region = regions_of(topology, count);
    std::vector<Index> sizes(static_cast<std::size_t>(count), 0);
    for (const Index r : region) ++sizes[r];
    std::vector<Index> way;
    for (Index r = 0; r < count && way.empty(); ++r) {
      if (sizes[r] % 2 != 0) way = way_to_odd(topology, region, sizes, r);
    }
    if (way.empty()) return mesh;
    for (const Index e : way) {
      const Index h = topology.edge_half_edge(e);
      halve_crease(mesh, topology.origin(h), topology.destination(h));
    }
  }
}

/// Takes out inner vertices with two faces: these become one.
bool take_out_doublets(Mesh& mesh) {
  const Topology topology(mesh);
  Buffer<std::uint8_t> kept(static_cast<std::size_t>(mesh.face_count()), 1);
  Buffer<std::uint8_t> touched(static_cast<std::size_t>(mesh.face_count()), 0);
  bool any = false;
  Buffer<std::uint8_t> creased(static_cast<std::size_t>(mesh.vertex_count()), 0);
  for (const Crease& crease : mesh.creases) creased[crease.a] = creased[crease.b] = 1;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (topology.is_boundary_vertex(v) || topology.vertex_face_count(v) != 2) continue;
    if (creased[v] != 0) continue;
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

Mesh paired_quads(const Mesh& triangles) {
  const Mesh mesh = even_regions(triangles);
  const Topology topology(mesh);
  const std::vector<double> limits{0.3, 0.45, 0.6, 0.7, 0.8, 0.9, 1.0, 1.2};
  const std::vector<Index> partner = maximum_matching(mesh.face_count(), ranked_pairs(topology, mesh.points), limits);
  Mesh quads;
  quads.points = mesh.points;
  quads.creases = mesh.creases;
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
