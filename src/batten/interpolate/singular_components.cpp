#include "batten/interpolate/singular_components.h"

#include <algorithm>

namespace batten {

namespace {

/// Collects the connected region of candidates around `seed`. False when it is not a whole component of candidates, or
/// not two-colourable. Every candidate is visited once over all calls.
bool colour_region(const LimitMatrix& matrix, Index seed, Buffer<std::int8_t>& sign, SingularComponent& component) {
  const Topology& topology = matrix.topology();
  const auto is_candidate = [&](Index v) {
    return matrix.row_kind(v) == LimitRow::Smooth && matrix.alpha(v) == 0.0 && matrix.face_count(v) == 3;
  };
  bool singular = true;
  sign[seed] = 1;
  component.vertices.push_back(seed);
  for (std::size_t i = 0; i < component.vertices.size(); ++i) {
    const Index v = component.vertices[i];
    topology.for_each_outgoing(v, [&](Index h) {
      const Index neighbour = topology.destination(h);
      const bool candidate = is_candidate(neighbour);
      if (candidate && sign[neighbour] == 0) {
        sign[neighbour] = static_cast<std::int8_t>(-sign[v]);
        component.vertices.push_back(neighbour);
      }
      if (!candidate || sign[neighbour] == sign[v]) singular = false;
    });
  }
  for (const Index v : component.vertices) component.sign.push_back(sign[v]);
  return singular;
}

}  // namespace

std::vector<SingularComponent> find_singular_components(const LimitMatrix& matrix) {
  std::vector<SingularComponent> components;
  if (matrix.scheme().kind == SchemeKind::Loop) return components;
  const Topology& topology = matrix.topology();
  Buffer<std::int8_t> sign(static_cast<std::size_t>(topology.vertex_count()), 0);
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (matrix.face_count(v) != 3 || sign[v] != 0 || matrix.row_kind(v) != LimitRow::Smooth || matrix.alpha(v) != 0.0) {
      continue;
    }
    SingularComponent component;
    if (colour_region(matrix, v, sign, component)) components.push_back(std::move(component));
  }
  return components;
}

bool has_valence_two(const LimitMatrix& matrix, const Buffer<Index>& vertices) {
  return std::any_of(vertices.begin(), vertices.end(),
                     [&](Index v) { return matrix.row_kind(v) == LimitRow::Smooth && matrix.face_count(v) == 2; });
}

}  // namespace batten
