#include "batten/refine/refined_rows.h"

#include <cassert>

#include "batten/refine/refined_points.h"
#include "batten/refine/refined_values.h"

namespace batten {

namespace {

/// A row in the making.
class WeightSum {
 public:
  WeightSum() { row_.reserve(kUsual); }

  void add(Index vertex) { add(1.0, vertex); }
  void add(double weight, Index vertex) { row_.emplace_back(vertex, weight); }
  void add(const WeightSum& sum) { add(1.0, sum); }
  /// The weights of one vertex are added up before they are weighted, as those of numbers are.
  void add(double weight, const WeightSum& sum) {
    for (const auto& [vertex, its_weight] : sum.merged()) row_.emplace_back(vertex, weight * its_weight);
  }

  VertexWeights merged() const {
    VertexWeights row = row_;
    merge(row);
    return row;
  }

 private:
  static constexpr std::size_t kUsual = 16;  ///< entries, so that most sums ask for memory once

  VertexWeights row_;
};

/// Rows of RefinedPoints, appended to a matrix as they are made.
struct MatrixRows {
  using Sum = WeightSum;

  const Topology& topology;
  SparseRows& matrix;

  Index vertex(Index v) const { return v; }
  WeightSum centroid(Index f) const {
    WeightSum corners;
    for (Index h = topology.face_begin(f); h < topology.face_end(f); ++h) corners.add(topology.origin(h));
    WeightSum sum;
    sum.add(1.0 / topology.face_size(f), corners);
    return sum;
  }
  void store(std::ptrdiff_t /*refined*/, double weight, const WeightSum& sum) const {
    for (const auto& [vertex, its_weight] : sum.merged()) {
      if (its_weight != 0.0) matrix.add(vertex, weight * its_weight);
    }
    matrix.end_row();
  }
};

/// Rows of RefinedPoints, weighted and added to a row. Centroids stand in it by their own numbers, those of face
/// points, until all is together: a large face's corners are then met once, not once for each of its edges.
struct PulledRows {
  using Sum = WeightSum;

  Index first_centroid;
  double factor;
  VertexWeights& row;

  Index vertex(Index v) const { return v; }
  Index centroid(Index f) const { return first_centroid + f; }
  void store(std::ptrdiff_t /*refined*/, double weight, const WeightSum& sum) const {
    for (const auto& [vertex, its_weight] : sum.merged()) row.emplace_back(vertex, factor * weight * its_weight);
  }
};

Index first_centroid(const Topology& topology) { return topology.vertex_count() + topology.edge_count(); }

/// Makes the row of a refined vertex that is no face point.
template <typename Rows>
void make_row(const RefinedPoints<Rows, 0>& points, const Topology& topology, Index refined, VertexRing& ring) {
  if (refined < topology.vertex_count()) {
    points.vertex_point(refined, ring);
  } else {
    points.edge_point(refined - topology.vertex_count());
  }
}

}  // namespace

SparseRows refined_rows(const Topology& topology, const Scheme& scheme) {
  assert(!is_interpolating(scheme.kind));
  const VertexMasks masks(scheme);
  SparseRows matrix;
  const RefinedPoints<MatrixRows, 0> points(topology, scheme, masks, MatrixRows{topology, matrix});
  const Index count = refined_vertex_count(topology, scheme.kind);
  VertexRing ring;
  for (Index v = 0; v < first_centroid(topology); ++v) make_row(points, topology, v, ring);
  for (Index v = first_centroid(topology); v < count; ++v) points.face_point(v - first_centroid(topology));
  return matrix;
}

struct RefinementPullback::Parts {
  Topology topology;
  Scheme scheme;
  VertexMasks masks{scheme};
};

RefinementPullback::RefinementPullback(const Topology& topology, const Scheme& scheme)
    : parts_(std::make_unique<Parts>(Parts{topology, scheme})) {
  assert(!is_interpolating(scheme.kind));
}

RefinementPullback::~RefinementPullback() = default;
RefinementPullback::RefinementPullback(RefinementPullback&&) noexcept = default;

VertexWeights RefinementPullback::operator()(const VertexWeights& row) const {
  const Topology& topology = parts_->topology;
  const Index centroids = first_centroid(topology);
  VertexWeights met;
  VertexRing ring;
  for (const auto& [refined, weight] : row) {
    if (weight == 0.0) continue;
    if (refined >= centroids) {
      met.emplace_back(refined, weight);
      continue;
    }
    const PulledRows rows{centroids, weight, met};
    make_row(RefinedPoints<PulledRows, 0>(topology, parts_->scheme, parts_->masks, rows), topology, refined, ring);
  }
  merge(met);
  VertexWeights result;
  for (const auto& [vertex, weight] : met) {
    if (vertex < centroids) {
      result.emplace_back(vertex, weight);
      continue;
    }
    const Index f = vertex - centroids;
    const double share = weight / topology.face_size(f);
    for (Index h = topology.face_begin(f); h < topology.face_end(f); ++h)
      result.emplace_back(topology.origin(h), share);
  }
  merge(result);
  return result;
}

}  // namespace batten
