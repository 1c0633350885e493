#include "cli/vertex_fields.h"

#include <algorithm>

namespace batten::cli {
namespace {

double edge_sharpness(const Topology& topology, Index edge) {
  if (topology.is_boundary_edge(edge)) return 0.0;
  return std::min(topology.edge_sharpness(edge), kInfiniteSharpness);
}

/// Vertices first, then one an edge, then, for Catmull-Clark, one a face (Refinement's order).
template <typename EdgeValue, typename FaceValue>
Scalars child_field(const Topology& topology, SchemeKind kind, const Scalars& field, const EdgeValue& edge_value,
                    const FaceValue& face_value) {
  const Index faces = kind == SchemeKind::CatmullClark ? topology.face_count() : 0;
  Scalars child(field.size() + topology.edge_count() + faces);
  child.head(field.size()) = field;
  for (Index e = 0; e < topology.edge_count(); ++e) {
    const Index h = topology.edge_half_edge(e);
    child[field.size() + e] = edge_value(e, topology.origin(h), topology.destination(h));
  }
  for (Index f = 0; f < faces; ++f) child[field.size() + topology.edge_count() + f] = face_value(f);
  return child;
}

}  // namespace

Scalars valences(const Topology& topology) {
  Scalars field = Scalars::Zero(topology.vertex_count());
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (topology.is_isolated(v)) continue;
    field[v] = (topology.is_boundary_vertex(v) ? 2.0 : 1.0) * topology.vertex_face_count(v);
  }
  return field;
}

Scalars sharpnesses(const Topology& topology) {
  Scalars field = Scalars::Zero(topology.vertex_count());
  for (Index v = 0; v < topology.vertex_count(); ++v)
    field[v] = std::min(topology.vertex_sharpness(v), kInfiniteSharpness);
  for (Index e = 0; e < topology.edge_count(); ++e) {
    const Index h = topology.edge_half_edge(e);
    for (const Index v : {topology.origin(h), topology.destination(h)})
      field[v] = std::max(field[v], edge_sharpness(topology, e));
  }
  return field;
}

Scalars spread(const Topology& topology, SchemeKind kind, const Scalars& field) {
  return child_field(
      topology, kind, field, [&](Index /*edge*/, Index a, Index b) { return 0.5 * (field[a] + field[b]); },
      [&](Index f) {
        double sum = 0.0;
        for (Index h = topology.face_begin(f); h < topology.face_end(f); ++h) sum += field[topology.origin(h)];
        return sum / topology.face_size(f);
      });
}

Scalars spread_creases(const Topology& topology, SchemeKind kind, const Scalars& field, int level, Index even_count) {
  return child_field(
      topology, kind, field,
      [&](Index edge, Index a, Index b) {
        if (level == 0) return edge_sharpness(topology, edge);
        const bool along = std::min(a, b) < even_count && field[a] > 0.0 && field[b] > 0.0;
        return along ? 0.5 * (field[a] + field[b]) : 0.0;
      },
      [](Index /*face*/) { return 0.0; });
}

}  // namespace batten::cli
