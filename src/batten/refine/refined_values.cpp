#include "batten/refine/refined_values.h"

#include <type_traits>

#include "batten/parallel/parallel.h"
#include "batten/refine/butterfly_rules.h"
#include "batten/refine/refined_points.h"

namespace batten {

namespace {

/// K columns of numbers: the given values, and the centroids that the pass before has made.
template <int K, typename Scalar>
struct NumberRows {
  struct Sum {
    double value[K] = {};

    template <typename Number>
    void add(const Number* row) {
      for (int c = 0; c < K; ++c) value[c] += row[c];
    }
    template <typename Number>
    void add(double weight, const Number* row) {
      for (int c = 0; c < K; ++c) value[c] += weight * row[c];
    }
    void add(double weight, const Sum& sum) { add(weight, sum.value); }
  };

  const double* in;
  std::ptrdiff_t in_stride;
  Scalar* out;
  std::ptrdiff_t out_stride;
  std::ptrdiff_t first_centroid;

  const double* vertex(std::ptrdiff_t v) const { return in + v * in_stride; }
  const Scalar* centroid(std::ptrdiff_t f) const { return out + (first_centroid + f) * out_stride; }
  void store(std::ptrdiff_t r, double weight, const Sum& sum) const {
    for (int c = 0; c < K; ++c) out[r * out_stride + c] = static_cast<Scalar>(weight * sum.value[c]);
  }
};

/// Centroids first, then edge points from them, then vertex points.
template <typename Rows, int S>
void fill_columns(const Topology& topology, const RefinedPoints<Rows, S>& columns, bool faces,
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
    const auto fill = [&](const auto& rows) {
      using Rows = std::decay_t<decltype(rows)>;
      fill_columns(topology, RefinedPoints<Rows, S>(topology, scheme, masks, rows), faces, part);
    };
    const double* in = values.data() + c;
    const std::ptrdiff_t first_centroid = std::ptrdiff_t{topology.vertex_count()} + topology.edge_count();
    if (end == c + 3) {
      fill(NumberRows<3, Scalar>{in, stride, out + c, k, first_centroid});
    } else {
      fill(NumberRows<1, Scalar>{in, stride, out + c, k, first_centroid});
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
