#include "batten/scheme/butterfly.h"

#include <cmath>
#include <numbers>

namespace batten {

namespace {

using std::numbers::pi;

constexpr int kTabulatedValences = 64;
constexpr int kTabulatedTriangles = 16;

RingMask zero_ring(int edges) {
  RingMask mask;
  mask.edges.resize(static_cast<std::size_t>(edges), 0.0);
  return mask;
}

}  // namespace

ButterflyMask butterfly_mask(const Scheme& scheme) {
  if (scheme.kind == SchemeKind::Butterfly) {
    const double w = scheme.tension.value_or(1.0 / 16.0);
    return {0.5, 2.0 * w, -w, 0.0};
  }
  const double w = scheme.tension.value_or(0.0);
  return {0.5 - w, 0.125 + 2.0 * w, -0.0625 - w, w};
}

CurveEndMask curve_end_mask(ButterflyBoundary boundary) {
  if (boundary == ButterflyBoundary::Reflect) return {7.0 / 16.0, 10.0 / 16.0, -1.0 / 16.0};
  return {6.0 / 16.0, 12.0 / 16.0, -2.0 / 16.0};
}

RingMask extraordinary_mask(int valence) {
  RingMask mask = zero_ring(valence);
  mask.vertex = 0.75;
  switch (valence) {
    case 2:
      mask.vertex = 0.5;
      mask.edges = {0.5, 0.0};
      return mask;
    case 3:
      mask.edges = {5.0 / 12.0, -1.0 / 12.0, -1.0 / 12.0};
      return mask;
    case 4:
      mask.edges = {3.0 / 8.0, 0.0, -1.0 / 8.0, 0.0};
      return mask;
    default:
      break;
  }
  const double theta = 2.0 * pi / valence;
  for (int j = 0; j < valence; ++j) {
    mask.edges[j] = (0.25 + std::cos(j * theta) + 0.5 * std::cos(2 * j * theta)) / valence;
  }
  return mask;
}

RingMask crease_vertex_mask(int triangles, int edge) {
  const int k = triangles;
  RingMask mask = zero_ring(k + 1);
  if (k == 2) {  // the limit of the general formula
    mask.vertex = 0.5;
    mask.edges[1] = 0.5;
    return mask;
  }
  const double theta = pi / k;
  const double sine = std::sin(edge * theta);
  const double sine2 = std::sin(2 * edge * theta);
  // sin/(1 - cos) and cos - cos 2 are written so that they do not cancel when there are many triangles.
  mask.vertex = 1.0 - sine / (k * std::tan(0.5 * theta));
  const double difference = 2.0 * std::sin(1.5 * theta) * std::sin(0.5 * theta);
  const double end = 0.25 * std::cos(edge * theta) - std::sin(2 * theta) * sine2 / (4.0 * k * difference);
  mask.edges.front() = end;
  mask.edges.back() = -end;
  for (int j = 1; j < k; ++j) {
    mask.edges[j] = (sine * std::sin(j * theta) + 0.5 * sine2 * std::sin(2 * j * theta)) / k;
  }
  return mask;
}

TangentMasks extraordinary_tangents(int valence) {
  TangentMasks masks{zero_ring(valence), zero_ring(valence)};
  const double theta = 2.0 * pi / valence;
  for (int j = 0; j < valence; ++j) {
    masks.first.edges[j] = std::cos(j * theta);
    masks.second.edges[j] = std::sin(j * theta);
  }
  return masks;
}

RingMask crease_vertex_cross_tangent(int triangles) {
  RingMask mask = zero_ring(triangles + 1);
  const double theta = pi / triangles;
  for (int i = 1; i < triangles; ++i) mask.edges[i] = std::sin(i * theta);
  mask.vertex = -1.0 / std::tan(0.5 * theta);
  return mask;
}

ButterflyMasks::ButterflyMasks(const Scheme& scheme)
    : modified_(scheme.kind == SchemeKind::ModifiedButterfly),
      boundary_(scheme.butterfly_boundary),
      stencil_(butterfly_mask(scheme)),
      curve_end_(curve_end_mask(scheme.butterfly_boundary)),
      extraordinary_(2),
      crease_(2) {
  for (int n = 2; n < kTabulatedValences; ++n) extraordinary_.push_back(extraordinary_mask(n));
  for (int k = 2; k < kTabulatedTriangles; ++k) {
    crease_.emplace_back(1);
    for (int i = 1; i < k; ++i) crease_.back().push_back(crease_vertex_mask(k, i));
  }
}

const RingMask& ButterflyMasks::extraordinary(int valence, RingMask& scratch) const {
  if (valence < kTabulatedValences) return extraordinary_[valence];
  return scratch = extraordinary_mask(valence);
}

const RingMask& ButterflyMasks::crease_vertex(int triangles, int edge, RingMask& scratch) const {
  if (triangles < kTabulatedTriangles) return crease_[triangles][edge];
  return scratch = crease_vertex_mask(triangles, edge);
}

}  // namespace batten
