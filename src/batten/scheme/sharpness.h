/// \file How sharpness decides the rule at a vertex or an edge, and how it decays (OpenSubdiv 3.5, sdc/crease; key
/// OSD).
///
/// Sharpness is computed in float, as OpenSubdiv does, so that semi-sharp weights agree to the last bit.
#pragma once
#include <span>

#include "batten/scheme/scheme.h"

namespace batten {

enum class VertexRule { Smooth, Dart, Crease, Corner };

inline bool is_sharp(float sharpness) { return sharpness > 0.0F; }
inline bool is_infinite(float sharpness) { return sharpness >= kInfiniteSharpness; }
inline bool is_semi_sharp(float sharpness) { return is_sharp(sharpness) && !is_infinite(sharpness); }

/// The sharpness one level down: 1 less; infinite sharpness stays infinite.
inline float subdivided_sharpness(float sharpness) {
  if (is_infinite(sharpness)) return kInfiniteSharpness;
  return sharpness > 1.0F ? sharpness - 1.0F : 0.0F;
}

/// The number of semi-sharp edges at a vertex and the sum of their sharpness.
struct SemiSharpEdges {
  float sum = 0.0F;
  int count = 0;
};
inline SemiSharpEdges semi_sharp_edges(std::span<const float> around) {
  SemiSharpEdges edges;
  for (const float sharpness : around) {
    if (!is_semi_sharp(sharpness)) continue;
    edges.sum += sharpness;
    ++edges.count;
  }
  return edges;
}

/// The sharpness of an edge's child at one end. `edge` is the edge's sharpness; `around` are all edges at that end.
/// Chaikin: 3/4 of the edge's and 1/4 of the average of the other semi-sharp edges', less one.
inline float subdivided_sharpness(float edge, SemiSharpEdges around, CreaseMethod method) {
  if (method == CreaseMethod::Uniform || !is_semi_sharp(edge) || around.count < 2) return subdivided_sharpness(edge);
  const float others = (around.sum - edge) / static_cast<float>(around.count - 1);
  // A quarter of a float is exact, so fusing the multiplication and the addition does not change the rounding.
  const float child = edge - 0.25F * edge + 0.25F * others - 1.0F;
  return is_sharp(child) ? child : 0.0F;
}
inline float subdivided_sharpness(float edge, std::span<const float> around, CreaseMethod method) {
  if (method == CreaseMethod::Uniform) return subdivided_sharpness(edge);
  return subdivided_sharpness(edge, semi_sharp_edges(around), method);
}

inline VertexRule vertex_rule(float vertex, std::span<const float> edges) {
  if (is_sharp(vertex)) return VertexRule::Corner;
  int sharp = 0;
  for (const float edge : edges) sharp += is_sharp(edge) ? 1 : 0;
  return sharp > 2 ? VertexRule::Corner : static_cast<VertexRule>(sharp);
}

/// The weight in [0, 1] of the parent's rule where the child's rule differs: the average of the sharpness values that
/// reach 0 in this step.
inline float transition_weight(float vertex, float child_vertex, std::span<const float> edges,
                               std::span<const float> child_edges) {
  float sum = 0.0F;
  int count = 0;
  if (is_sharp(vertex) && !is_sharp(child_vertex)) {
    sum = vertex;
    count = 1;
  }
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (!is_sharp(edges[i]) || is_sharp(child_edges[i])) continue;
    sum += edges[i];
    ++count;
  }
  if (count == 0) return 0.0F;
  const float weight = sum / static_cast<float>(count);
  return weight > 1.0F ? 1.0F : weight;
}

}  // namespace batten
