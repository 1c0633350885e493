#include "batten/limit/ring_limit.h"

#include <cmath>

namespace batten {

namespace {

constexpr int kMostFixedPointSteps = 2000;

RingMask zero_mask(const RingRules& rules) {
  return {0.0, std::vector<double>(static_cast<std::size_t>(rules.edge_count()), 0.0),
          std::vector<double>(static_cast<std::size_t>(rules.face_count()), 0.0)};
}

int next_edge(const RingRules& rules, int j) { return j + 1 == rules.edge_count() ? 0 : j + 1; }
int previous_edge(const RingRules& rules, int j) { return j == 0 ? rules.edge_count() - 1 : j - 1; }

/// Moves weights of centroids to the corners of the quad: c_j = (v + e_j + e_{j+1} + f_j)/4.
void spread_centroids(const RingRules& rules, const std::vector<double>& centroids, RingMask& mask) {
  for (int j = 0; j < rules.face_count(); ++j) {
    const double quarter = 0.25 * centroids[j];
    mask.vertex += quarter;
    mask.edges[j] += quarter;
    mask.edges[next_edge(rules, j)] += quarter;
    mask.faces[j] += quarter;
  }
}

/// The weight of the midpoint in the new point of edge j.
double sharp_weight(const RingRules& rules, SemiSharpEdges around, int j) {
  const float sharpness = rules.sharpness[j];
  if (!is_sharp(sharpness)) return 0.0;
  if (sharpness >= 1.0F) return 1.0;
  const float near = subdivided_sharpness(sharpness, around, rules.crease_method);
  return is_sharp(near) && is_sharp(rules.outer_sharpness[j]) ? 1.0 : sharpness;
}

int triangles_at(const RingRules& rules, int j) {
  if (rules.smooth_triangles.empty()) return 0;
  return rules.smooth_triangles[j] + rules.smooth_triangles[previous_edge(rules, j)];
}

void pull_back_edges(const RingRules& rules, const RingMask& child, RingMask& mask, std::vector<double>& centroids) {
  const bool quads = rules.kind == SchemeKind::CatmullClark;
  Scheme scheme;
  scheme.kind = rules.kind;
  scheme.triangle_rule = rules.smooth_triangles.empty() ? TriangleRule::Catmark : TriangleRule::Smooth;
  const SemiSharpEdges around = semi_sharp_edges(rules.sharpness);
  for (int j = 0; j < rules.edge_count(); ++j) {
    const double weight = child.edges[j];
    const double sharp = sharp_weight(rules, around, j);
    double end = 0.5;
    if (sharp < 1.0) {
      const EdgeMask smooth = edge_mask(scheme, triangles_at(rules, j));
      end = sharp * 0.5 + (1.0 - sharp) * smooth.end;
      const double across = weight * (1.0 - sharp) * smooth.face;
      std::vector<double>& target = quads ? centroids : mask.edges;
      target[previous_edge(rules, j)] += across;
      target[quads ? j : next_edge(rules, j)] += across;
    }
    mask.vertex += weight * end;
    mask.edges[j] += weight * end;
  }
}

void pull_back_vertex(const RingRules& rules, double weight, RingMask& mask, std::vector<double>& centroids) {
  const VertexBlend blend = ring_blend(rules.vertex_sharpness, rules.sharpness, rules.crease_method);
  if (blend.smooth > 0.0) {
    const SmoothMask smooth = vertex_mask(rules.kind, rules.edge_count(), rules.alpha);
    mask.vertex += weight * blend.smooth * smooth.vertex;
    for (double& edge : mask.edges) edge += weight * blend.smooth * smooth.edge;
    for (double& centroid : centroids) centroid += weight * blend.smooth * smooth.face;
  }
  if (blend.crease > 0.0) {
    mask.edges[blend.crease_a] += weight * blend.crease * kCreaseNeighbour;
    mask.edges[blend.crease_b] += weight * blend.crease * kCreaseNeighbour;
  }
  mask.vertex += weight * (blend.crease * kCreaseVertex + blend.corner);
}

/// The mask on this ring that has the same value as `child` on the refined ring.
RingMask pull_back(const RingRules& rules, const RingMask& child) {
  RingMask mask = zero_mask(rules);
  std::vector<double> centroids = child.faces;  // a face point is the face's centroid
  pull_back_edges(rules, child, mask, centroids);
  pull_back_vertex(rules, child.vertex, mask, centroids);
  if (rules.kind == SchemeKind::CatmullClark) spread_centroids(rules, centroids, mask);
  return mask;
}

/// The rules one level down: tags are one less, and all faces are quads.
RingRules child_rules(const RingRules& rules) {
  RingRules child = rules;
  child.alpha = 0.0;
  child.smooth_triangles.clear();
  child.vertex_sharpness = subdivided_sharpness(rules.vertex_sharpness);
  const SemiSharpEdges around = semi_sharp_edges(rules.sharpness);
  for (std::size_t j = 0; j < child.sharpness.size(); ++j) {
    child.sharpness[j] = subdivided_sharpness(rules.sharpness[j], around, rules.crease_method);
    const float at_midpoint[] = {child.sharpness[j], rules.outer_sharpness[j]};
    child.outer_sharpness[j] = subdivided_sharpness(child.sharpness[j], at_midpoint, rules.crease_method);
  }
  return child;
}

bool is_stationary(const RingRules& rules) {
  bool fades = is_semi_sharp(rules.vertex_sharpness) || !rules.smooth_triangles.empty() || rules.alpha != 0.0;
  for (const float sharpness : rules.sharpness) fades = fades || is_semi_sharp(sharpness);
  return !fades;
}

/// The rules of each level until all sharpness is 0 or infinite; the last ones are stationary.
std::vector<RingRules> levels_of(const RingRules& rules) {
  std::vector<RingRules> levels{rules};
  while (!is_stationary(levels.back())) levels.push_back(child_rules(levels.back()));
  return levels;
}

RingMask pull_back_through(const std::vector<RingRules>& levels, RingMask mask) {
  for (std::size_t level = levels.size() - 1; level-- > 0;) mask = pull_back(levels[level], mask);
  return mask;
}

VertexRule rule_of(const RingRules& rules) { return vertex_rule(rules.vertex_sharpness, rules.sharpness); }

RingMask smooth_position(const RingRules& rules) {
  RingMask mask = zero_mask(rules);
  const SmoothMask smooth = limit_mask(rules.kind, rules.edge_count());
  mask.vertex = smooth.vertex;
  for (double& edge : mask.edges) edge = smooth.edge;
  if (rules.kind == SchemeKind::CatmullClark) {
    spread_centroids(rules, std::vector<double>(mask.faces.size(), smooth.face), mask);
  }
  return mask;
}

double difference(const RingMask& a, const RingMask& b) {
  double most = std::abs(a.vertex - b.vertex);
  for (std::size_t j = 0; j < a.edges.size(); ++j) most = std::max(most, std::abs(a.edges[j] - b.edges[j]));
  for (std::size_t j = 0; j < a.faces.size(); ++j) most = std::max(most, std::abs(a.faces[j] - b.faces[j]));
  return most;
}

double sum_of(const RingMask& mask) {
  double sum = mask.vertex;
  for (const double edge : mask.edges) sum += edge;
  for (const double face : mask.faces) sum += face;
  return sum;
}

/// Sets mask to (mask - shift other) scale.
void combine(RingMask& mask, double shift, const RingMask& other, double scale) {
  mask.vertex = (mask.vertex - shift * other.vertex) * scale;
  for (std::size_t j = 0; j < mask.edges.size(); ++j) mask.edges[j] = (mask.edges[j] - shift * other.edges[j]) * scale;
  for (std::size_t j = 0; j < mask.faces.size(); ++j) mask.faces[j] = (mask.faces[j] - shift * other.faces[j]) * scale;
}

/// The left eigenvector of eigenvalue 1, found by pulling the smooth mask back until it is stationary. The other
/// eigenvalues are at most about 0.66, so this takes about 80 steps.
RingMask dart_position(const RingRules& rules) {
  RingMask mask = smooth_position(rules);
  for (int step = 0; step < kMostFixedPointSteps; ++step) {
    RingMask next = pull_back(rules, mask);
    combine(next, 0.0, next, 1.0 / sum_of(next));
    const double change = difference(next, mask);
    mask = std::move(next);
    if (change < 1e-17) break;
  }
  return mask;
}

RingMask stationary_position(const RingRules& rules, LimitMasks choice) {
  RingMask mask = zero_mask(rules);
  switch (rule_of(rules)) {
    case VertexRule::Smooth:
    case VertexRule::Dart:
      if (choice == LimitMasks::Exact) {
        return rule_of(rules) == VertexRule::Dart ? dart_position(rules) : smooth_position(rules);
      }
      if (rules.edge_count() > 2 || rules.kind == SchemeKind::Loop) return smooth_position(rules);
      break;
    case VertexRule::Crease:
      mask.vertex = kCreaseLimitVertex;
      for (std::size_t j = 0; j < mask.edges.size(); ++j) {
        if (is_sharp(rules.sharpness[j])) mask.edges[j] = kCreaseLimitNeighbour;
      }
      return mask;
    case VertexRule::Corner:
      break;
  }
  mask.vertex = 1.0;
  return mask;
}

/// Averages a mask with its mirror image in the edge `crease`. This removes the odd eigenvector, which rounding
/// introduces and which shrinks more slowly than the even one.
void make_even(const RingRules& rules, int crease, RingMask& mask) {
  const int n = rules.edge_count();
  const RingMask before = mask;
  for (int j = 0; j < n; ++j) {
    mask.edges[j] = 0.5 * (before.edges[j] + before.edges[(2 * crease - j + 2 * n) % n]);
    mask.faces[j] = 0.5 * (before.faces[j] + before.faces[(2 * crease - 1 - j + 2 * n) % n]);
  }
}

/// The even eigenvector beside a dart's crease is found by power iteration with the constants deflated. The odd one is
/// the smooth sine mask, on which the crease does not act.
TangentMasks dart_tangents(const RingRules& rules, int crease) {
  const TangentMasks smooth = smooth_tangents(rules.kind, rules.edge_count());
  const auto turned = [&](const RingMask& mask) {
    RingMask result = zero_mask(rules);
    for (int j = 0; j < rules.edge_count(); ++j) {
      const int from = (j - crease + rules.edge_count()) % rules.edge_count();
      result.edges[j] = mask.edges[from];
      result.faces[j] = mask.faces[from];
    }
    return result;
  };
  const RingMask position = dart_position(rules);
  RingMask even = turned(smooth.first);
  for (int step = 0; step < kMostFixedPointSteps; ++step) {
    RingMask next = pull_back(rules, even);
    make_even(rules, crease, next);
    combine(next, sum_of(next), position, 1.0);
    combine(next, 0.0, next, std::abs(even.edges[crease]) / std::max(std::abs(next.edges[crease]), 1e-300));
    const double change = difference(next, even);
    even = std::move(next);
    if (change < 1e-15) break;
  }
  return {even, turned(smooth.second)};
}

RingMask edge_difference(const RingRules& rules, int edge) {
  RingMask mask = zero_mask(rules);
  mask.vertex = -1.0;
  mask.edges[edge] = 1.0;
  return mask;
}

TangentMasks crease_sector(const RingRules& rules, int first, int faces, LimitMasks choice) {
  const CreaseTangents which = choice == LimitMasks::Exact ? CreaseTangents::Exact : CreaseTangents::OpenSubdiv;
  const TangentMasks local = crease_tangents(rules.kind, faces, which);
  const auto placed = [&](const RingMask& from) {
    RingMask mask = zero_mask(rules);
    mask.vertex = from.vertex;
    for (int j = 0; j <= faces; ++j) mask.edges[(first + j) % rules.edge_count()] += from.edges[j];
    for (int j = 0; j < faces; ++j) mask.faces[(first + j) % rules.face_count()] += from.faces[j];
    return mask;
  };
  return {placed(local.first), placed(local.second)};
}

/// The tangents of the stationary rules in the sector that starts at edge `first`.
TangentMasks sector_tangents(const RingRules& rules, int first, int faces, LimitMasks choice) {
  const int n = rules.edge_count();
  switch (rule_of(rules)) {
    case VertexRule::Smooth:
      if (n == 2) break;
      return smooth_tangents(rules.kind, n);
    case VertexRule::Dart:
      if (n == 2 && (choice == LimitMasks::OpenSubdiv && rules.kind == SchemeKind::CatmullClark)) break;
      return choice == LimitMasks::Exact && n > 2 ? dart_tangents(rules, first) : smooth_tangents(rules.kind, n);
    case VertexRule::Crease:
      return crease_sector(rules, first, faces, choice);
    case VertexRule::Corner:
      break;
  }
  // A fixed vertex takes two edges: the sides of its sector, or the first two edges where no side is sharp.
  const int last = rule_of(rules) == VertexRule::Corner && faces < n ? (first + faces) % n : next_edge(rules, first);
  return {edge_difference(rules, first), edge_difference(rules, last)};
}

}  // namespace

RingRules ring_rules(const Topology& topology, const Scheme& scheme, double alpha, Index vertex, VertexRing& ring) {
  gather_ring(topology, vertex, ring);
  RingRules rules;
  rules.kind = scheme.kind;
  rules.crease_method = scheme.crease_method;
  rules.closed = ring.closed;
  rules.alpha = alpha;
  rules.vertex_sharpness = vertex_sharpness(topology, scheme, vertex);
  rules.sharpness = ring.sharpness;
  rules.outer_sharpness.resize(ring.sharpness.size());
  VertexRing far;
  for (std::size_t j = 0; j < ring.sharpness.size(); ++j) {
    const float sharpness = ring.sharpness[j];
    if (scheme.crease_method == CreaseMethod::Uniform || !is_semi_sharp(sharpness)) {
      rules.outer_sharpness[j] = subdivided_sharpness(sharpness);
    } else {
      gather_ring(topology, ring.neighbours[j], far);
      rules.outer_sharpness[j] = subdivided_sharpness(sharpness, far.sharpness, scheme.crease_method);
    }
  }
  if (scheme.kind == SchemeKind::CatmullClark && scheme.triangle_rule == TriangleRule::Smooth) {
    bool any = false;
    rules.smooth_triangles.resize(ring.corners.size());
    for (std::size_t j = 0; j < ring.corners.size(); ++j) {
      rules.smooth_triangles[j] = topology.face_size(topology.face(ring.corners[j])) == 3 ? 1 : 0;
      any = any || rules.smooth_triangles[j] != 0;
    }
    // The outer edges of an open ring are sharp and have no second face, so no edge looks past the ring's end.
    if (!any) rules.smooth_triangles.clear();
  }
  return rules;
}

RingMask limit_position_mask(const RingRules& rules, LimitMasks choice) {
  const std::vector<RingRules> levels = levels_of(rules);
  return pull_back_through(levels, stationary_position(levels.back(), choice));
}

std::vector<RingSector> limit_sectors(const RingRules& rules, LimitMasks choice) {
  const std::vector<RingRules> levels = levels_of(rules);
  const RingRules& last = levels.back();
  std::vector<int> sharp;
  for (int j = 0; j < last.edge_count(); ++j) {
    if (is_sharp(last.sharpness[j])) sharp.push_back(j);
  }
  std::vector<RingSector> sectors;
  const auto add = [&](int first, int faces) {
    TangentMasks tangents = sector_tangents(last, first, faces, choice);
    tangents.first = pull_back_through(levels, std::move(tangents.first));
    tangents.second = pull_back_through(levels, std::move(tangents.second));
    sectors.push_back({first, faces, std::move(tangents)});
  };
  if (last.closed && sharp.size() < 2) {
    add(sharp.empty() ? 0 : sharp[0], last.face_count());
    return sectors;
  }
  const std::size_t count = last.closed ? sharp.size() : sharp.size() - 1;
  for (std::size_t i = 0; i < count; ++i) {
    const int faces = (sharp[(i + 1) % sharp.size()] - sharp[i] + last.edge_count()) % last.edge_count();
    add(sharp[i], faces == 0 ? last.face_count() : faces);
  }
  return sectors;
}

}  // namespace batten
