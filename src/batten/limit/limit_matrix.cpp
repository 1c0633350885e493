#include "batten/limit/limit_matrix.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <string>

#include "batten/error.h"
#include "batten/limit/butterfly_normals.h"
#include "batten/limit/ring_limit.h"
#include "batten/mesh/checked_values.h"
#include "batten/mesh/vertex_fans.h"
#include "batten/parallel/parallel.h"
#include "batten/refine/child_topology.h"

namespace batten {

namespace {

/// Weights on the vertices around: a weight on a quad corner f_j acts through 4 c_j - v - e_j - e_{j+1}.
template <typename Visit>
void visit_ring(const Topology& topology, Index vertex, const VertexRing& ring, const RingMask& mask, bool quads,
                const Visit& visit) {
  visit(vertex, mask.vertex);
  for (std::size_t j = 0; j < ring.neighbours.size(); ++j) visit(ring.neighbours[j], mask.edges[j]);
  if (!quads) return;
  for (std::size_t j = 0; j < ring.corners.size(); ++j) {
    const double weight = mask.faces[j];
    if (weight == 0.0) continue;
    const Index f = topology.face(ring.corners[j]);
    visit(vertex, -weight);
    visit(ring.neighbours[j], -weight);
    visit(ring.neighbours[j + 1 == ring.neighbours.size() ? 0 : j + 1], -weight);
    const double share = 4.0 * weight / topology.face_size(f);
    for (Index h = topology.face_begin(f); h < topology.face_end(f); ++h) visit(topology.origin(h), share);
  }
}

}  // namespace

LimitMatrix::LimitMatrix(const Topology& topology, const Scheme& scheme, LimitOptions options, const Progress& progress)
    : topology_(topology), scheme_(scheme), options_(std::move(options)) {
  require_triangles(topology, scheme);
  if (!options_.vertex_alpha.empty() && static_cast<Index>(options_.vertex_alpha.size()) != topology.vertex_count()) {
    throw Error(ErrorCode::BadShape, "vertex_alpha must have one entry a vertex");
  }
  constexpr int kUsualValences = 32;
  if (!is_interpolating(scheme.kind)) {
    usual_weights_.push_back({});
    for (int n = 1; n <= kUsualValences; ++n) usual_weights_.push_back(compute_weights(n, scheme.alpha));
  }
  kinds_.resize(static_cast<std::size_t>(topology.vertex_count()));
  face_counts_.resize(static_cast<std::size_t>(topology.vertex_count()));
  const Buffer<Index> counts = vertex_face_counts(topology);
  const auto classify_block = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    VertexRing ring;
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      face_counts_[v] = static_cast<std::uint8_t>(std::min(255, counts[v]));
      classify(v, ring);
    }
  };
  parallel_for(topology.vertex_count(), classify_block, kDefaultBlock, progress_within(progress, 0.0, 0.5));
  special_offsets_.push_back(0);
  VertexRing ring;
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (v % kDefaultBlock == 0) report_progress(progress, 0.5 + 0.5 * v / topology.vertex_count());
    if (row_kind(v) == LimitRow::Special) add_special_row(v, ring);
  }
}

void LimitMatrix::classify(Index vertex, VertexRing& ring) {
  LimitRow row = LimitRow::Smooth;
  const bool plain_triangles =
      scheme_.kind != SchemeKind::CatmullClark || scheme_.triangle_rule == TriangleRule::Catmark;
  if (topology_.is_isolated(vertex) || is_interpolating(scheme_.kind)) {
    row = LimitRow::Fixed;
  } else if (!is_untagged(topology_) || topology_.is_boundary_vertex(vertex) || !plain_triangles) {
    gather_ring(topology_, vertex, ring);
    const float corner = vertex_sharpness(topology_, scheme_, vertex);
    bool fades = is_semi_sharp(corner);
    bool triangles = false;
    for (const float sharpness : ring.sharpness) fades = fades || is_semi_sharp(sharpness);
    for (const Index h : ring.corners) triangles = triangles || topology_.face_size(topology_.face(h)) == 3;
    switch (vertex_rule(corner, ring.sharpness)) {
      case VertexRule::Smooth:
        row = !plain_triangles && triangles ? LimitRow::Special : LimitRow::Smooth;
        break;
      case VertexRule::Dart:
        row = LimitRow::Special;
        break;
      case VertexRule::Crease:
        row = fades ? LimitRow::Special : LimitRow::Curve;
        break;
      case VertexRule::Corner:
        row = fades && !is_infinite(corner) ? LimitRow::Special : LimitRow::Fixed;
        break;
    }
  }
  if (row == LimitRow::Smooth && options_.masks == LimitMasks::OpenSubdiv && scheme_.kind == SchemeKind::CatmullClark &&
      face_count(vertex) == 2) {
    row = LimitRow::Fixed;
  }
  kinds_[vertex] = static_cast<std::uint8_t>(row);
}

void LimitMatrix::add_special_row(Index vertex, VertexRing& ring) {
  const RingRules rules = ring_rules(topology_, scheme_, alpha(vertex), vertex, ring);
  const RingMask mask = limit_position_mask(rules, options_.masks);
  std::vector<std::pair<Index, double>> entries;
  visit_ring(topology_, vertex, ring, mask, scheme_.kind == SchemeKind::CatmullClark,
             [&](Index column, double weight) { entries.emplace_back(column, weight); });
  std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  special_vertices_.push_back(vertex);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (i > 0 && entries[i].first == entries[i - 1].first) {
      special_weights_.back() += entries[i].second;
    } else {
      special_columns_.push_back(entries[i].first);
      special_weights_.push_back(entries[i].second);
    }
  }
  special_offsets_.push_back(special_columns_.size());
}

LimitMatrix::Weights LimitMatrix::compute_weights(int valence, double alpha) const {
  const SmoothMask mask = limit_mask(scheme_.kind, valence, alpha);
  return {mask.vertex, mask.edge, mask.face};
}

double LimitMatrix::row_scale(Index vertex) const {
  if (row_kind(vertex) != LimitRow::Smooth) return 1.0;
  const double n = face_count(vertex);
  if (scheme_.kind == SchemeKind::CatmullClark) return n * (n + 5.0);
  return 1.0 / limit_mask(SchemeKind::Loop, static_cast<int>(n)).edge;
}

std::pair<Index, Index> LimitMatrix::curve_neighbours(Index vertex) const {
  if (topology_.is_boundary_vertex(vertex)) {
    const Index first = topology_.vertex_half_edge(vertex);
    Index last = first;
    topology_.for_each_outgoing(vertex, [&](Index h) { last = h; });
    return {topology_.destination(first), topology_.origin(topology_.previous(last))};
  }
  std::pair<Index, Index> ends(-1, -1);
  topology_.for_each_outgoing(vertex, [&](Index h) {
    if (!is_sharp(topology_.edge_sharpness(topology_.edge(h)))) return;
    (ends.first < 0 ? ends.first : ends.second) = topology_.destination(h);
  });
  return ends;
}

Index LimitMatrix::special_place(Index vertex) const {
  return static_cast<Index>(std::lower_bound(special_vertices_.begin(), special_vertices_.end(), vertex) -
                            special_vertices_.begin());
}

template <int K>
void LimitMatrix::apply_columns(ConstValuesRef values, ValuesRef result, Buffer<double>& face_means,
                                const Progress& progress) const {
  const double* in = values.data();
  const std::ptrdiff_t stride = values.outerStride();
  const auto columns = K > 0 ? K : static_cast<int>(values.cols());
  const auto add = [&](double* target, double weight, const double* row) {
    for (int c = 0; c < (K > 0 ? K : columns); ++c) target[c] += weight * row[c];
  };
  const bool quads = scheme_.kind == SchemeKind::CatmullClark;
  if (quads) {
    face_means.resize(static_cast<std::size_t>(topology_.face_count()) * columns);
    const auto means = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      for (auto f = static_cast<Index>(begin); f < end; ++f) {
        double* mean = face_means.data() + static_cast<std::ptrdiff_t>(f) * columns;
        for (int c = 0; c < columns; ++c) mean[c] = 0.0;
        const double share = 1.0 / topology_.face_size(f);
        for (Index h = topology_.face_begin(f); h < topology_.face_end(f); ++h) {
          add(mean, share, in + topology_.origin(h) * stride);
        }
      }
    };
    parallel_for(topology_.face_count(), means, kDefaultBlock, progress_within(progress, 0.0, 0.4));
  }
  const auto rows = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      double* target = result.data() + v * result.outerStride();
      for (int c = 0; c < columns; ++c) target[c] = 0.0;
      if (row_kind(v) != LimitRow::Smooth) {
        visit_row(v, [&](Index column, double weight) { add(target, weight, in + column * stride); });
        continue;
      }
      const Weights weights = smooth_weights(v, face_count(v));
      for_each_spoke(topology_, v, [&](Index h, Index destination) {
        add(target, weights.edge, in + destination * stride);
        if (quads) {
          add(target, weights.face, face_means.data() + static_cast<std::ptrdiff_t>(topology_.face(h)) * columns);
        }
      });
      add(target, weights.vertex, in + v * stride);
    }
  };
  parallel_for(topology_.vertex_count(), rows, kDefaultBlock, progress_within(progress, 0.4, 1.0));
}

Values LimitMatrix::apply(ConstValuesRef values, const Progress& progress) const {
  Values result(values.rows(), values.cols());
  apply_into(values, result, progress);
  return result;
}

void LimitMatrix::apply_into(ConstValuesRef values, ValuesRef result, const Progress& progress) const {
  require_vertex_rows(topology_, values);
  require_shape(result, values.rows(), values.cols());
  require_finite(values, "values");
  apply_unchecked(values, result, progress);
}

void LimitMatrix::apply_unchecked(ConstValuesRef values, ValuesRef result, const Progress& progress) const {
  if (result.size() == 0) return;
  Buffer<double> face_means = face_means_->take();
  if (values.cols() == 3) {
    apply_columns<3>(values, result, face_means, progress);
  } else {
    apply_columns<0>(values, result, face_means, progress);
  }
  face_means_->give_back(std::move(face_means));
}

double LimitMatrix::entry_count() const {
  if (scheme_.kind == SchemeKind::Loop) return 2.0 * topology_.edge_count();
  if (const double size = topology_.uniform_face_size(); size > 0.0)
    return topology_.face_count() * size * (size - 2.0);
  double count = 0.0;
  for (Index f = 0; f < topology_.face_count(); ++f) {
    const double size = topology_.face_size(f);
    count += size * (size - 2.0);
  }
  return count;
}

Eigen::SparseMatrix<double, Eigen::RowMajor> LimitMatrix::matrix() const {
  std::vector<Eigen::Triplet<double>> entries;
  for (Index v = 0; v < topology_.vertex_count(); ++v) {
    visit_row(v, [&](Index column, double weight) { entries.emplace_back(v, column, weight); });
  }
  Eigen::SparseMatrix<double, Eigen::RowMajor> matrix(topology_.vertex_count(), topology_.vertex_count());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

namespace {

/// The smooth tangents of the usual valences, computed once.
class SmoothTangents {
 public:
  explicit SmoothTangents(SchemeKind kind) {
    for (int n = 3; n < kCount; ++n) tangents_.push_back(smooth_tangents(kind, n));
  }
  const TangentMasks* find(int valence) const {
    return valence >= 3 && valence < kCount ? &tangents_[valence - 3] : nullptr;
  }

 private:
  static constexpr int kCount = 33;
  std::vector<TangentMasks> tangents_;
};

/// The normals around one vertex, written where they belong.
class NormalWriter {
 public:
  NormalWriter(const Topology& topology, const Scheme& scheme, ConstValuesRef control, LimitMasks masks,
               LimitNormals& normals)
      : topology_(topology),
        scheme_(scheme),
        control_(control),
        masks_(masks),
        normals_(normals),
        smooth_(scheme.kind) {}

  void write(Index vertex, VertexRing& ring) const {
    if (topology_.is_isolated(vertex)) return;
    const bool plain = is_untagged(topology_) && scheme_.triangle_rule == TriangleRule::Catmark && scheme_.alpha == 0.0;
    if (plain && !topology_.is_boundary_vertex(vertex)) {
      gather_ring(topology_, vertex, ring);
      const auto valence = static_cast<int>(ring.edges.size());
      if (const TangentMasks* tangents = smooth_.find(valence))
        return write_sector(vertex, ring, 0, valence, *tangents, true);
    }
    const RingRules rules = ring_rules(topology_, scheme_, scheme_.alpha, vertex, ring);
    bool first = true;
    for (const RingSector& sector : limit_sectors(rules, masks_)) {
      write_sector(vertex, ring, sector.first_face, sector.face_count, sector.tangents, first);
      first = false;
    }
  }

 private:
  Eigen::Vector3d tangent(Index vertex, const VertexRing& ring, const RingMask& mask) const {
    double sum[3] = {0.0, 0.0, 0.0};
    visit_ring(topology_, vertex, ring, mask, scheme_.kind == SchemeKind::CatmullClark,
               [&](Index column, double weight) {
                 for (int c = 0; c < 3; ++c) sum[c] += weight * control_(column, c);
               });
    return {sum[0], sum[1], sum[2]};
  }

  void write_sector(Index vertex, const VertexRing& ring, int first_face, int face_count, const TangentMasks& tangents,
                    bool first) const {
    const Eigen::Vector3d cross = tangent(vertex, ring, tangents.first).cross(tangent(vertex, ring, tangents.second));
    const double length = cross.norm();
    if (!(length > 0.0)) return;
    const auto place = [&](Values& target, Index row) {
      for (int c = 0; c < 3; ++c) target(row, c) = cross[c] / length;
    };
    if (first) place(normals_.vertices, vertex);
    for (int i = 0; i < face_count; ++i) {
      place(normals_.corners, ring.corners[static_cast<std::size_t>(first_face + i) % ring.corners.size()]);
    }
  }

  const Topology& topology_;
  const Scheme& scheme_;
  ConstValuesRef control_;
  LimitMasks masks_;
  LimitNormals& normals_;
  SmoothTangents smooth_;
};

}  // namespace

LimitNormals limit_normals(const Topology& topology, const Scheme& scheme, ConstValuesRef control, LimitMasks masks,
                           const Progress& progress) {
  require_vertex_rows(topology, control);
  require_triangles(topology, scheme);
  if (control.cols() != 3) throw Error(ErrorCode::BadShape, "normals need three columns");
  if (is_interpolating(scheme.kind)) return butterfly_normals(topology, scheme, control, progress);
  LimitNormals normals{Values::Zero(topology.vertex_count(), 3), Values::Zero(topology.half_edge_count(), 3)};
  const NormalWriter writer(topology, scheme, control, masks, normals);
  const auto write_block = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    VertexRing ring;
    for (auto v = static_cast<Index>(begin); v < end; ++v) writer.write(v, ring);
  };
  parallel_for(topology.vertex_count(), write_block, kDefaultBlock, progress);
  return normals;
}

}  // namespace batten
