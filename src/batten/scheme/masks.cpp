#include "batten/scheme/masks.h"

#include <cmath>
#include <numbers>

namespace batten {

namespace {

using std::numbers::pi;
/// Stam and Loop's weight for edge points beside triangles, with OpenSubdiv's digits.
constexpr double kSmoothTriangleWeight = 0.470;

double loop_beta(int valence) {
  const double root = 0.375 + 0.25 * std::cos(2.0 * pi / valence);
  return (0.625 - root * root) / valence;
}

/// A_n of Thall's (15); theta is the angle between neighbouring edges in the characteristic map.
double catmull_clark_a(double theta) {
  return 1.0 + std::cos(theta) + std::cos(0.5 * theta) * std::sqrt(2.0 * (9.0 + std::cos(theta)));
}

RingMask zero_ring(int edges, int faces) {
  return {0.0, std::vector<double>(static_cast<std::size_t>(edges), 0.0),
          std::vector<double>(static_cast<std::size_t>(faces), 0.0)};
}

RingMask opensubdiv_cross(SchemeKind kind, int k) {
  RingMask mask = zero_ring(k + 1, k);
  const double theta = pi / k;
  if (k == 1) {
    mask.vertex = -6.0;
    mask.edges = {3.0, 3.0};
  } else if (kind == SchemeKind::CatmullClark) {
    const double r = (std::cos(theta) + 1.0) / std::sin(theta);
    const double d = 1.0 / (k * (3.0 + std::cos(theta)));
    mask.vertex = 4.0 * r * (std::cos(theta) - 1.0) * d;
    mask.edges.front() = mask.edges.back() = -r * (1.0 + 2.0 * std::cos(theta)) * d;
    for (int j = 1; j < k; ++j) mask.edges[j] = 4.0 * std::sin(j * theta) * d;
    for (int j = 0; j < k; ++j) mask.faces[j] = (std::sin(j * theta) + std::sin((j + 1) * theta)) * d;
  } else if (k == 2) {
    mask.vertex = -3.0;
    mask.edges[1] = 3.0;
  } else if (k == 3) {
    const double root = std::sqrt(3.0);
    mask.vertex = -root;
    mask.edges = {-0.5 * root, root, root, -0.5 * root};
  } else {
    mask.edges.front() = mask.edges.back() = -3.0 * std::sin(theta);
    for (int j = 1; j < k; ++j) mask.edges[j] = -6.0 * (std::cos(theta) - 1.0) * std::sin(j * theta);
  }
  return mask;
}

/// The left eigenvector of the ring's refinement matrix (docs/mathematics.md, Limit tangents), for k >= 2.
RingMask exact_cross(SchemeKind kind, int k) {
  RingMask mask = zero_ring(k + 1, k);
  const double theta = pi / k;
  const double cotangent = 1.0 / std::tan(0.5 * theta);
  double lambda = 0.0;
  double first = 0.0;  // right-hand sides of the two equations for x = e_0 = e_k and y = v
  double second = 0.0;
  if (kind == SchemeKind::CatmullClark) {
    const double a = catmull_clark_a(theta);
    lambda = (4.0 + a) / 16.0;
    for (int j = 1; j < k; ++j) mask.edges[j] = a * std::sin(j * theta);
    for (int j = 0; j < k; ++j) mask.faces[j] = std::sin(j * theta) + std::sin((j + 1) * theta);
    first = lambda * std::sin(theta);
    second = (2.0 * lambda + 0.25 * a) * cotangent;
  } else {
    lambda = 0.375 + 0.25 * std::cos(theta);
    for (int j = 1; j < k; ++j) mask.edges[j] = std::sin(j * theta);
    first = 0.125 * std::sin(theta);
    second = 0.375 * cotangent;
  }
  // (lambda - 1/2) x - y/8 = first;  -x + (lambda - 3/4) y = second.
  const double determinant = (lambda - 0.5) * (lambda - 0.75) - 0.125;
  mask.edges.front() = mask.edges.back() = (first * (lambda - 0.75) + 0.125 * second) / determinant;
  mask.vertex = ((lambda - 0.5) * second + first) / determinant;
  return mask;
}

}  // namespace

SmoothMask vertex_mask(SchemeKind kind, int valence, double alpha) {
  const double n = valence;
  if (kind == SchemeKind::Loop) {
    if (valence == 6) return {0.625, 0.0625, 0.0};
    const double beta = loop_beta(valence);
    return {1.0 - n * beta, beta, 0.0};
  }
  return {(n - 2.0 + alpha) / n, (1.0 - alpha) / (n * n), 1.0 / (n * n)};
}

SmoothMask limit_mask(SchemeKind kind, int valence, double alpha) {
  const double n = valence;
  if (kind == SchemeKind::Loop) {
    const double w = valence == 6 ? 6.0 : 3.0 / (8.0 * loop_beta(valence));
    return {w / (w + n), 1.0 / (w + n), 0.0};
  }
  const double scale = 1.0 / (n * (n + 5.0));
  return {(n * (n - 1.0) + n * alpha) * scale, (2.0 - alpha) * scale, 4.0 * scale};
}

EdgeMask edge_mask(const Scheme& scheme, int triangles) {
  if (scheme.kind == SchemeKind::Loop) return {0.375, 0.125};
  if (scheme.triangle_rule == TriangleRule::Catmark || triangles == 0) return {0.25, 0.25};
  const double face = triangles == 2 ? kSmoothTriangleWeight : 0.5 * (kSmoothTriangleWeight + 0.25);
  return {0.5 * (1.0 - 2.0 * face), face};
}

TangentMasks smooth_tangents(SchemeKind kind, int valence) {
  const double theta = 2.0 * pi / valence;
  const bool quads = kind == SchemeKind::CatmullClark;
  const double a = quads ? catmull_clark_a(theta) : 1.0;
  TangentMasks masks{zero_ring(valence, valence), zero_ring(valence, valence)};
  for (int j = 0; j < valence; ++j) {
    masks.first.edges[j] = a * std::cos(j * theta);
    masks.second.edges[j] = a * std::sin(j * theta);
    if (!quads) continue;
    masks.first.faces[j] = std::cos(j * theta) + std::cos((j + 1) * theta);
    masks.second.faces[j] = std::sin(j * theta) + std::sin((j + 1) * theta);
  }
  return masks;
}

TangentMasks crease_tangents(SchemeKind kind, int faces, CreaseTangents choice) {
  const int exact_until = kind == SchemeKind::CatmullClark ? 3 : 5;
  const bool exact = choice == CreaseTangents::Exact && faces >= 2 && faces <= exact_until;
  TangentMasks masks{zero_ring(faces + 1, faces), exact ? exact_cross(kind, faces) : opensubdiv_cross(kind, faces)};
  const double along = kind == SchemeKind::CatmullClark ? 0.5 : 1.5;
  masks.first.edges.front() = along;
  masks.first.edges.back() = -along;
  return masks;
}

double subdominant_eigenvalue(SchemeKind kind, int valence) {
  const double theta = 2.0 * pi / valence;
  return kind == SchemeKind::Loop ? 0.375 + 0.25 * std::cos(theta) : (4.0 + catmull_clark_a(theta)) / 16.0;
}

}  // namespace batten
