#include "batten/limit/butterfly_tangents.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace batten {

namespace {

constexpr double kPi = std::numbers::pi;

/// Two rings around a vertex whose neighbours are all regular, and the matrix S of one step.
class TwoRings {
 public:
  TwoRings(const Scheme& scheme, ButterflyFan fan, int triangles)
      : closed_(fan == ButterflyFan::Closed || fan == ButterflyFan::Dart),
        triangles_(triangles),
        edges_(closed_ ? triangles : triangles + 1),
        points_(static_cast<std::size_t>(size())) {
    Mesh mesh = make_mesh();
    if (fan == ButterflyFan::Dart)
      mesh.creases = {{edge(0), 0, kInfiniteSharpness}, {edge(0), beyond(0), kInfiniteSharpness}};
    const Topology topology(mesh);
    Scheme plain = scheme;
    plain.boundary = BoundaryRule::EdgeOnly;
    const Buffer<ButterflyVertex> kinds = butterfly_vertices(topology, plain);
    const ButterflyMasks masks(scheme);
    const auto point_of = [&](Index half_edge) {
      return butterfly_point(topology, kinds, masks, topology.edge(half_edge));
    };
    points_[0] = {{0}, {1.0}};
    for (int j = 0; j < edges_; ++j) {
      points_[edge(j)] = point_of(j < triangles ? 3 * j : 3 * j - 1);
      points_[beyond(j)] = {{edge(j)}, {1.0}};
    }
    for (int j = 0; j < triangles; ++j) points_[across(j)] = point_of(3 * j + 1);
  }

  int triangles() const { return triangles_; }
  int edges() const { return edges_; }
  Index size() const { return 1 + 2 * edges_ + triangles_; }
  Index edge(int j) const { return 1 + j % edges_; }
  Index beyond(int j) const { return 1 + edges_ + j % edges_; }
  Index across(int j) const { return 1 + 2 * edges_ + j; }

  /// S^T y.
  std::vector<double> transposed(const std::vector<double>& y) const {
    std::vector<double> out(y.size(), 0.0);
    for (std::size_t i = 0; i < y.size(); ++i) {
      for (std::size_t j = 0; j < points_[i].vertices.size(); ++j) {
        out[points_[i].vertices[j]] += points_[i].weights[j] * y[i];
      }
    }
    return out;
  }

  TwoRingMask mask(const std::vector<double>& y) const {
    const auto begin = y.begin() + 1;
    return {y[0], {begin, begin + edges_}, {begin + edges_, begin + 2 * edges_}, {begin + 2 * edges_, y.end()}};
  }

 private:
  Mesh make_mesh() const {
    Mesh mesh;
    mesh.points = Points::Zero(size(), 3);
    mesh.face_offsets = {0};
    const auto add = [&](Index a, Index b, Index c) {
      mesh.face_vertices.insert(mesh.face_vertices.end(), {a, b, c});
      mesh.face_offsets.push_back(static_cast<Index>(mesh.face_vertices.size()));
    };
    for (int j = 0; j < triangles_; ++j) add(0, edge(j), edge(j + 1));
    for (int j = 0; j < triangles_; ++j) {
      add(edge(j), beyond(j), across(j));
      add(edge(j), across(j), edge(j + 1));
      add(edge(j + 1), across(j), beyond(j + 1));
    }
    return mesh;
  }

  bool closed_;
  int triangles_;
  int edges_;
  std::vector<ButterflyPoint> points_;
};

/// Iterates y = S^T y from `start` until its direction is stationary. project() removes rounding errors in other
/// eigenspaces.
template <typename Project>
TwoRingMask left_eigenvector(const TwoRings& rings, std::vector<double> start, const Project& project) {
  constexpr int kMost = 2000;
  constexpr double kConverged = 1e-15;
  std::vector<double> y = std::move(start);
  for (int i = 0; i < kMost; ++i) {
    std::vector<double> next = rings.transposed(y);
    project(next);
    double largest = 0.0;
    for (const double weight : next) largest = std::max(largest, std::abs(weight));
    if (!(largest > 0.0)) break;
    double change = 0.0;
    for (std::size_t j = 0; j < y.size(); ++j) {
      next[j] /= largest;
      change = std::max(change, std::abs(next[j] - y[j]));
    }
    y = std::move(next);
    if (change < kConverged) break;
  }
  return rings.mask(y);
}

/// cos or sin around the vertex. A dart has no such symmetry; there it is the start of the iteration only.
std::vector<double> wave(const TwoRings& rings, double phase, const std::array<double, 3>& amplitudes) {
  std::vector<double> y(static_cast<std::size_t>(rings.size()), 0.0);
  const double theta = 2.0 * kPi / rings.triangles();
  for (int j = 0; j < rings.triangles(); ++j) {
    y[rings.edge(j)] = amplitudes[0] * std::cos(j * theta - phase);
    y[rings.beyond(j)] = amplitudes[1] * std::cos(j * theta - phase);
    y[rings.across(j)] = amplitudes[2] * std::cos((j + 0.5) * theta - phase);
  }
  return y;
}

TwoRingMask closed_tangent(const TwoRings& rings, double phase) {
  const std::vector<double> edges = wave(rings, phase, {1.0, 0.0, 0.0});
  const std::vector<double> beyond = wave(rings, phase, {0.0, 1.0, 0.0});
  const std::vector<double> across = wave(rings, phase, {0.0, 0.0, 1.0});
  const auto dot = [](const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
  };
  return left_eigenvector(rings, edges, [&](std::vector<double>& y) {
    y = wave(rings, phase,
             {dot(y, edges) / dot(edges, edges), dot(y, beyond) / dot(beyond, beyond),
              dot(y, across) / dot(across, across)});
  });
}

ButterflyTangentMasks closed_tangents(const TwoRings& rings) {
  return {closed_tangent(rings, 0.0), closed_tangent(rings, 0.5 * kPi)};
}

/// Both tangents have the eigenvalue 1/2, so any two independent starts are enough; their orientation is preserved.
ButterflyTangentMasks dart_tangents(const TwoRings& rings) {
  const auto keep = [](std::vector<double>& y) {
    double sum = 0.0;
    for (const double weight : y) sum += weight;
    y[0] -= sum;
  };
  return {left_eigenvector(rings, wave(rings, 0.0, {1.0, 0.0, 0.0}), keep),
          left_eigenvector(rings, wave(rings, 0.5 * kPi, {1.0, 0.0, 0.0}), keep)};
}

TwoRingMask along_curve(int edges) {
  TwoRingMask mask;
  mask.edges.resize(static_cast<std::size_t>(edges), 0.0);
  mask.beyond = mask.edges;
  mask.edges.front() = kCurveTangentNear;
  mask.beyond.front() = kCurveTangentFar;
  mask.edges.back() = -kCurveTangentNear;
  mask.beyond.back() = -kCurveTangentFar;
  return mask;
}

/// The tangent across the curve. The fan's mirror symmetry separates it from the tangent along the curve.
TwoRingMask across_curve(const TwoRings& rings) {
  const int k = rings.triangles();
  std::vector<double> start(static_cast<std::size_t>(rings.size()), 0.0);
  for (int i = 1; i < k; ++i) start[rings.edge(i)] = std::sin(i * kPi / k);
  for (int i = 1; i < k; ++i) start[0] -= start[rings.edge(i)];
  return left_eigenvector(rings, start, [&](std::vector<double>& y) {
    const auto level = [&](Index a, Index b) { y[a] = y[b] = 0.5 * (y[a] + y[b]); };
    for (int i = 0; 2 * i < rings.edges(); ++i) {
      level(rings.edge(i), rings.edge(k - i));
      level(rings.beyond(i), rings.beyond(k - i));
    }
    for (int i = 0; 2 * i < k; ++i) level(rings.across(i), rings.across(k - 1 - i));
    double sum = 0.0;
    for (const double weight : y) sum += weight;
    y[0] -= sum;
  });
}

/// The triangle shrinks towards the curve faster than along it, and the plane beside it has no limit: second
/// differences of the four-point scheme keep turning, ever more slowly. The mask therefore spans the plane of the curve
/// and the next point at this level.
TwoRingMask across_single_triangle() { return {-1.0, {0.0, 0.0}, {}, {1.0}}; }

ButterflyTangentMasks make_masks(const Scheme& scheme, ButterflyFan fan, int k) {
  const bool modified = scheme.kind == SchemeKind::ModifiedButterfly;
  const bool rules = modified && scheme.butterfly_boundary == ButterflyBoundary::CreaseRules;
  switch (fan) {
    case ButterflyFan::Closed: {
      if (!modified || k == 6) return closed_tangents(TwoRings(scheme, fan, k));
      const TangentMasks masks = extraordinary_tangents(k);
      return {{0.0, masks.first.edges, {}, {}}, {0.0, masks.second.edges, {}, {}}};
    }
    case ButterflyFan::Dart:
      return dart_tangents(TwoRings(scheme, fan, k));
    case ButterflyFan::Curve:
      break;
  }
  if (k == 1) return {along_curve(k + 1), across_single_triangle()};
  if (!rules || k == 3) return {along_curve(k + 1), across_curve(TwoRings(scheme, fan, k))};
  const RingMask cross = crease_vertex_cross_tangent(k);
  return {along_curve(k + 1), {cross.vertex, cross.edges, {}, {}}};
}

}  // namespace

const ButterflyTangentMasks& ButterflyTangents::make(ButterflyFan fan, int triangles) {
  const auto found = masks_.find({fan, triangles});
  if (found != masks_.end()) return found->second;
  return masks_.emplace(std::pair(fan, triangles), make_masks(scheme_, fan, triangles)).first->second;
}

}  // namespace batten
