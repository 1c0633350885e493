/// \file The rules of one refinement step under Catmull-Clark and Loop, for any kind of row: numbers, or weights.
#pragma once
#include <array>
#include <span>

#include "batten/mesh/topology.h"
#include "batten/refine/vertex_blend.h"
#include "batten/scheme/masks.h"

namespace batten {

/// Steps around faces that all have S corners, without a look at the tables; S = 0 asks them.
template <int S>
struct Walk {
  const Topology& topology;

  Index face(Index h) const {
    if constexpr (S > 0) return h / S;
    return topology.face(h);
  }
  Index next(Index h) const {
    if constexpr (S > 0) return h % S == S - 1 ? h - (S - 1) : h + 1;
    return topology.next(h);
  }
  Index previous(Index h) const {
    if constexpr (S > 0) return h % S == 0 ? h + (S - 1) : h - 1;
    return topology.previous(h);
  }
  Index face_size(Index f) const {
    if constexpr (S > 0) return S;
    return topology.face_size(f);
  }
  Index destination(Index h) const { return topology.origin(next(h)); }
};

/// Masks of the usual valences where alpha is the same everywhere.
class VertexMasks {
 public:
  /// vertex_alpha: empty, or one for each vertex; it must outlive the masks.
  explicit VertexMasks(const Scheme& scheme, std::span<const double> vertex_alpha = {})
      : kind_(scheme.kind), alpha_(scheme.alpha), vertex_alpha_(vertex_alpha) {
    for (int n = 2; n < kTabulated; ++n) table_[n] = vertex_mask(kind_, n, alpha_);
  }
  SmoothMask operator()(Index vertex, int valence) const {
    if (!vertex_alpha_.empty()) return vertex_mask(kind_, valence, vertex_alpha_[vertex]);
    return valence >= 2 && valence < kTabulated ? table_[valence] : vertex_mask(kind_, valence, alpha_);
  }

 private:
  static constexpr int kTabulated = 32;
  SchemeKind kind_;
  double alpha_;
  std::span<const double> vertex_alpha_;
  std::array<SmoothMask, kTabulated> table_{};
};

/// Makes the points of one step. Rows says what a row is: it has a type Sum, which starts as zero, with add(row),
/// add(weight, row) and add(weight, sum); vertex(v) and centroid(f) give the rows of a vertex and of a face's centroid,
/// and store(i, weight, sum) takes weight times a sum for the row of refined vertex i. S: corners of every face, or 0.
template <typename Rows, int S>
class RefinedPoints {
 public:
  RefinedPoints(const Topology& topology, const Scheme& scheme, const VertexMasks& masks, const Rows& rows)
      : topology_(topology),
        walk_{topology},
        scheme_(scheme),
        masks_(masks),
        quads_(scheme.kind == SchemeKind::CatmullClark),
        untagged_(is_untagged(topology)),
        rows_(rows) {}

  void face_point(Index f) const {
    Sum sum;
    const Index first = topology_.face_begin(f);
    const Index size = walk_.face_size(f);
    for (Index h = first; h < first + size; ++h) sum.add(row(topology_.origin(h)));
    rows_.store(std::ptrdiff_t{topology_.vertex_count()} + topology_.edge_count() + f, 1.0 / size, sum);
  }

  void edge_point(Index e) const {
    const Index h = topology_.edge_half_edge(e);
    const Index twin = topology_.twin(h);
    const double sharp = twin < 0 ? 1.0 : sharp_weight(e);
    Sum sum;
    double end = 0.5;
    if (sharp < 1.0) {
      const int triangles =
          (walk_.face_size(walk_.face(h)) == 3 ? 1 : 0) + (walk_.face_size(walk_.face(twin)) == 3 ? 1 : 0);
      const EdgeMask smooth = edge_mask(scheme_, triangles);
      add_across(sum, (1.0 - sharp) * smooth.face, h);
      add_across(sum, (1.0 - sharp) * smooth.face, twin);
      end = sharp * 0.5 + (1.0 - sharp) * smooth.end;
    }
    sum.add(end, row(topology_.origin(h)));
    sum.add(end, row(walk_.destination(h)));
    rows_.store(std::ptrdiff_t{topology_.vertex_count()} + e, 1.0, sum);
  }

  void vertex_point(Index v, VertexRing& ring) const {
    Sum sum;
    if (topology_.is_isolated(v)) {
      sum.add(row(v));
    } else if (is_plain(v)) {
      add_smooth(v, 1.0, sum);
    } else {
      const VertexBlend blend = vertex_blend(topology_, scheme_, v, ring);
      if (blend.smooth > 0.0) add_smooth(v, blend.smooth, sum);
      if (blend.crease > 0.0) {
        sum.add(blend.crease * kCreaseNeighbour, row(blend.crease_a));
        sum.add(blend.crease * kCreaseNeighbour, row(blend.crease_b));
      }
      sum.add(blend.crease * kCreaseVertex + blend.corner, row(v));
    }
    rows_.store(v, 1.0, sum);
  }

 private:
  using Sum = typename Rows::Sum;

  auto row(Index v) const { return rows_.vertex(v); }

  /// What stands across the edge on the side of half-edge h: the face's centroid, or Loop's opposite vertex.
  void add_across(Sum& sum, double weight, Index h) const {
    if (quads_) {
      sum.add(weight, rows_.centroid(walk_.face(h)));
    } else {
      sum.add(weight, row(topology_.origin(walk_.previous(h))));
    }
  }

  /// Weight of the crease mask in an edge point: 1 when sharp, fading with the last fraction of sharpness.
  double sharp_weight(Index e) const {
    const float sharpness = topology_.edge_sharpness(e);
    if (!is_sharp(sharpness)) return 0.0;
    if (sharpness >= 1.0F || edge_stays_sharp(topology_, scheme_.crease_method, e)) return 1.0;
    return sharpness;
  }

  /// No boundary and no tag touches it.
  bool is_plain(Index v) const {
    if (topology_.is_boundary_vertex(v)) return false;
    if (untagged_) return true;
    bool plain = !is_sharp(topology_.vertex_sharpness(v));
    topology_.for_each_outgoing(
        v, [&](Index h) { plain = plain && !is_sharp(topology_.edge_sharpness(topology_.edge(h))); });
    return plain;
  }

  void add_smooth(Index v, double weight, Sum& sum) const {
    Sum edges;
    Sum faces;
    int valence = 0;
    const Index start = topology_.vertex_half_edge(v);
    Index h = start;
    do {
      ++valence;
      edges.add(row(walk_.destination(h)));
      if (quads_) faces.add(rows_.centroid(walk_.face(h)));
      h = topology_.twin(walk_.previous(h));
    } while (h != start && h >= 0);
    const SmoothMask mask = masks_(v, valence);
    sum.add(weight * mask.edge, edges);
    if (quads_) sum.add(weight * mask.face, faces);
    sum.add(weight * mask.vertex, row(v));
  }

  const Topology& topology_;
  Walk<S> walk_;
  const Scheme& scheme_;
  const VertexMasks& masks_;
  bool quads_;
  bool untagged_;
  Rows rows_;
};

}  // namespace batten
