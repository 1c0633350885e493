#include "batten/refine/vertex_blend.h"

namespace batten {

namespace {

bool has_single_face(const Topology& topology, Index vertex) {
  return topology.twin(topology.previous(topology.vertex_half_edge(vertex))) < 0;
}

void add_rule(VertexBlend& blend, VertexRule rule, double weight, std::span<const float> sharpness) {
  switch (rule) {
    case VertexRule::Smooth:
    case VertexRule::Dart:
      blend.smooth += weight;
      return;
    case VertexRule::Corner:
      blend.corner += weight;
      return;
    case VertexRule::Crease:
      blend.crease += weight;
      for (std::size_t i = 0; i < sharpness.size(); ++i) {
        if (!is_sharp(sharpness[i])) continue;
        (blend.crease_a < 0 ? blend.crease_a : blend.crease_b) = static_cast<Index>(i);
      }
  }
}

Buffer<float> child_sharpness_of(std::span<const float> sharpness, CreaseMethod method) {
  Buffer<float> child(sharpness.size());
  const SemiSharpEdges around = semi_sharp_edges(sharpness);
  for (std::size_t i = 0; i < child.size(); ++i) child[i] = subdivided_sharpness(sharpness[i], around, method);
  return child;
}

}  // namespace

float vertex_sharpness(const Topology& topology, const Scheme& scheme, Index vertex) {
  if (scheme.boundary == BoundaryRule::EdgeAndCorner && topology.is_boundary_vertex(vertex) &&
      has_single_face(topology, vertex)) {
    return kInfiniteSharpness;
  }
  return topology.vertex_sharpness(vertex);
}

void gather_ring(const Topology& topology, Index vertex, VertexRing& ring) {
  ring.edges.clear();
  ring.neighbours.clear();
  ring.sharpness.clear();
  ring.corners.clear();
  ring.closed = !topology.is_boundary_vertex(vertex);
  const auto add = [&](Index edge, Index neighbour) {
    ring.edges.push_back(edge);
    ring.neighbours.push_back(neighbour);
    ring.sharpness.push_back(topology.edge_sharpness(edge));
  };
  Index last = -1;
  topology.for_each_outgoing(vertex, [&](Index h) {
    add(topology.edge(h), topology.destination(h));
    ring.corners.push_back(h);
    last = h;
  });
  if (ring.closed) return;
  const Index incoming = topology.previous(last);
  add(topology.edge(incoming), topology.origin(incoming));
}

Buffer<float> child_sharpness(const VertexRing& ring, CreaseMethod method) {
  return child_sharpness_of(ring.sharpness, method);
}

bool edge_stays_sharp(const Topology& topology, CreaseMethod method, Index edge) {
  const float sharpness = topology.edge_sharpness(edge);
  if (method == CreaseMethod::Uniform) return is_sharp(subdivided_sharpness(sharpness));
  const Index h = topology.edge_half_edge(edge);
  VertexRing ring;
  for (const Index end : {topology.origin(h), topology.destination(h)}) {
    gather_ring(topology, end, ring);
    if (!is_sharp(subdivided_sharpness(sharpness, ring.sharpness, method))) return false;
  }
  return true;
}

VertexRule vertex_rule_of(const Topology& topology, const Scheme& scheme, Index vertex, VertexRing& ring) {
  gather_ring(topology, vertex, ring);
  return vertex_rule(vertex_sharpness(topology, scheme, vertex), ring.sharpness);
}

bool is_untagged(const Topology& topology) { return !topology.has_creases() && !topology.has_corners(); }

VertexBlend ring_blend(float sharpness, std::span<const float> edges, CreaseMethod method) {
  VertexBlend blend;
  const VertexRule rule = vertex_rule(sharpness, edges);
  if (rule == VertexRule::Smooth || rule == VertexRule::Dart) return blend;
  const Buffer<float> child_edges = child_sharpness_of(edges, method);
  const float child_vertex = subdivided_sharpness(sharpness);
  const VertexRule child_rule = vertex_rule(child_vertex, child_edges);
  blend.smooth = 0.0;
  if (child_rule == rule) {
    add_rule(blend, rule, 1.0, edges);
    return blend;
  }
  const double weight = transition_weight(sharpness, child_vertex, edges, child_edges);
  add_rule(blend, rule, weight, edges);
  add_rule(blend, child_rule, 1.0 - weight, child_edges);
  return blend;
}

VertexBlend vertex_blend(const Topology& topology, const Scheme& scheme, Index vertex, VertexRing& ring) {
  gather_ring(topology, vertex, ring);
  VertexBlend blend = ring_blend(vertex_sharpness(topology, scheme, vertex), ring.sharpness, scheme.crease_method);
  if (blend.crease_a >= 0) {
    blend.crease_a = ring.neighbours[blend.crease_a];
    blend.crease_b = ring.neighbours[blend.crease_b];
  }
  return blend;
}

}  // namespace batten
