#include "batten/refine/refined_values.h"

#include <array>

#include "batten/parallel/parallel.h"
#include "batten/refine/butterfly_rules.h"
#include "batten/refine/vertex_blend.h"
#include "batten/scheme/masks.h"

namespace batten {

namespace {

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

template <int K>
struct Sum {
  double value[K] = {};

  template <typename Scalar>
  void add(const Scalar* row) {
    for (int c = 0; c < K; ++c) value[c] += row[c];
  }
  template <typename Row>
  void add(double weight, const Row* row) {
    for (int c = 0; c < K; ++c) value[c] += weight * row[c];
  }
};

/// Masks of the usual valences where alpha is the same everywhere.
class VertexMasks {
 public:
  VertexMasks(const Scheme& scheme, std::span<const double> vertex_alpha)
      : scheme_(scheme), vertex_alpha_(vertex_alpha) {
    for (int n = 2; n < kTabulated; ++n) table_[n] = vertex_mask(scheme.kind, n, scheme.alpha);
  }
  SmoothMask operator()(Index vertex, int valence) const {
    if (!vertex_alpha_.empty()) return vertex_mask(scheme_.kind, valence, vertex_alpha_[vertex]);
    return valence >= 2 && valence < kTabulated ? table_[valence] : vertex_mask(scheme_.kind, valence, scheme_.alpha);
  }

 private:
  static constexpr int kTabulated = 32;
  const Scheme& scheme_;
  std::span<const double> vertex_alpha_;
  std::array<SmoothMask, kTabulated> table_{};
};

/// K columns in one pass: centroids first, then edge points from them, then vertex points.
template <int K, int S, typename Scalar>
class Columns {
 public:
  Columns(const Topology& topology, const Scheme& scheme, const VertexMasks& masks, const double* in,
          std::ptrdiff_t in_stride, Scalar* out, std::ptrdiff_t out_stride)
      : topology_(topology),
        walk_{topology},
        scheme_(scheme),
        masks_(masks),
        quads_(scheme.kind == SchemeKind::CatmullClark),
        untagged_(is_untagged(topology)),
        in_(in),
        in_stride_(in_stride),
        out_(out),
        out_stride_(out_stride) {}

  void face_point(Index f) const {
    Sum<K> sum;
    const Index first = topology_.face_begin(f);
    const Index size = walk_.face_size(f);
    for (Index h = first; h < first + size; ++h) sum.add(row(topology_.origin(h)));
    store(face_row(f), 1.0 / size, sum);
  }

  void edge_point(Index e) const {
    const Index h = topology_.edge_half_edge(e);
    const Index twin = topology_.twin(h);
    const double sharp = twin < 0 ? 1.0 : sharp_weight(e);
    Sum<K> sum;
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
    store(std::ptrdiff_t{topology_.vertex_count()} + e, 1.0, sum);
  }

  void vertex_point(Index v, VertexRing& ring) const {
    Sum<K> sum;
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
    store(v, 1.0, sum);
  }

 private:
  const double* row(std::ptrdiff_t r) const { return in_ + r * in_stride_; }
  std::ptrdiff_t face_row(Index f) const {
    return std::ptrdiff_t{topology_.vertex_count()} + topology_.edge_count() + f;
  }
  void store(std::ptrdiff_t r, double weight, const Sum<K>& sum) const {
    for (int c = 0; c < K; ++c) out_[r * out_stride_ + c] = static_cast<Scalar>(weight * sum.value[c]);
  }

  /// What stands across the edge on the side of half-edge h: the face's centroid, or Loop's opposite vertex.
  void add_across(Sum<K>& sum, double weight, Index h) const {
    if (quads_) {
      sum.add(weight, out_ + face_row(walk_.face(h)) * out_stride_);
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

  void add_smooth(Index v, double weight, Sum<K>& sum) const {
    Sum<K> edges;
    Sum<K> faces;
    int valence = 0;
    const Index start = topology_.vertex_half_edge(v);
    Index h = start;
    do {
      ++valence;
      edges.add(row(walk_.destination(h)));
      if (quads_) faces.add(out_ + face_row(walk_.face(h)) * out_stride_);
      h = topology_.twin(walk_.previous(h));
    } while (h != start && h >= 0);
    const SmoothMask mask = masks_(v, valence);
    sum.add(weight * mask.edge, edges.value);
    if (quads_) sum.add(weight * mask.face, faces.value);
    sum.add(weight * mask.vertex, row(v));
  }

  const Topology& topology_;
  Walk<S> walk_;
  const Scheme& scheme_;
  const VertexMasks& masks_;
  bool quads_;
  bool untagged_;
  const double* in_;
  std::ptrdiff_t in_stride_;
  Scalar* out_;
  std::ptrdiff_t out_stride_;
};

template <int K, int S, typename Scalar>
void fill_columns(const Topology& topology, const Columns<K, S, Scalar>& columns, bool faces,
                  const Progress& progress) {
  if (faces) {
    parallel_for(
        topology.face_count(),
        [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          for (auto f = static_cast<Index>(begin); f < end; ++f) columns.face_point(f);
        },
        kDefaultBlock, progress_within(progress, 0.0, 0.2));
  }
  parallel_for(
      topology.edge_count(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        for (auto e = static_cast<Index>(begin); e < end; ++e) columns.edge_point(e);
      },
      kDefaultBlock, progress_within(progress, 0.2, 0.6));
  parallel_for(
      topology.vertex_count(),
      [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        VertexRing ring;
        for (auto v = static_cast<Index>(begin); v < end; ++v) columns.vertex_point(v, ring);
      },
      kDefaultBlock, progress_within(progress, 0.6, 1.0));
}

/// Three columns at a time, then one by one.
template <int S, typename Scalar>
void fill_all_columns(const Topology& topology, const Scheme& scheme, const VertexMasks& masks, ConstValuesRef values,
                      Scalar* out, const Progress& progress) {
  const std::ptrdiff_t k = values.cols();
  const std::ptrdiff_t stride = values.outerStride();
  const bool faces = scheme.kind == SchemeKind::CatmullClark;
  for (std::ptrdiff_t c = 0; c < k;) {
    const std::ptrdiff_t end = k - c >= 3 ? c + 3 : c + 1;
    const Progress part = progress_within(progress, static_cast<double>(c) / static_cast<double>(k),
                                          static_cast<double>(end) / static_cast<double>(k));
    const double* in = values.data() + c;
    if (end == c + 3) {
      fill_columns(topology, Columns<3, S, Scalar>(topology, scheme, masks, in, stride, out + c, k), faces, part);
    } else {
      fill_columns(topology, Columns<1, S, Scalar>(topology, scheme, masks, in, stride, out + c, k), faces, part);
    }
    c = end;
  }
}

}  // namespace

Index refined_vertex_count(const Topology& topology, SchemeKind kind) {
  return topology.vertex_count() + topology.edge_count() +
         (kind == SchemeKind::CatmullClark ? topology.face_count() : 0);
}

template <typename Scalar>
void refine_values(const Topology& topology, const Scheme& scheme, std::span<const double> vertex_alpha,
                   ConstValuesRef values, Scalar* out, const Progress& progress) {
  if (is_interpolating(scheme.kind)) return refine_butterfly_values(topology, scheme, values, out, progress);
  const VertexMasks masks(scheme, vertex_alpha);
  switch (topology.uniform_face_size()) {
    case 3:
      return fill_all_columns<3>(topology, scheme, masks, values, out, progress);
    case 4:
      return fill_all_columns<4>(topology, scheme, masks, values, out, progress);
    default:
      return fill_all_columns<0>(topology, scheme, masks, values, out, progress);
  }
}

template void refine_values(const Topology&, const Scheme&, std::span<const double>, ConstValuesRef, float*,
                            const Progress&);
template void refine_values(const Topology&, const Scheme&, std::span<const double>, ConstValuesRef, double*,
                            const Progress&);

}  // namespace batten
