#include "batten/refine/refinement.h"

#include <array>
#include <cmath>
#include <string>

#include "batten/error.h"
#include "batten/parallel/parallel.h"
#include "batten/refine/child_topology.h"
#include "batten/refine/vertex_blend.h"
#include "batten/scheme/masks.h"

namespace batten {

namespace {

/// Rows of k numbers; K = 0 stands for a k known only at run time.
template <int K>
class Rows {
 public:
  Rows(const double* data, std::ptrdiff_t stride, int columns) : data_(data), stride_(stride), columns_(columns) {}
  int columns() const { return K > 0 ? K : columns_; }
  const double* operator[](std::ptrdiff_t row) const { return data_ + row * stride_; }

 private:
  const double* data_;
  std::ptrdiff_t stride_;
  int columns_;
};

template <int K>
void add(double* out, double weight, const double* in, int columns) {
  for (int c = 0; c < (K > 0 ? K : columns); ++c) out[c] += weight * in[c];
}

/// The columns of one pass: centroids first, then edge points from them, then vertex points.
template <int K>
struct Step {
  const Topology& topology;
  const Topology& child;
  const Scheme& scheme;
  Rows<K> in;
  double* out;
  int columns;

  double* row(std::ptrdiff_t r) const { return out + r * (K > 0 ? K : columns); }
  void clear(double* target) const {
    for (int c = 0; c < (K > 0 ? K : columns); ++c) target[c] = 0.0;
  }

  void face_point(Index f) const {
    double* target = row(std::ptrdiff_t{topology.vertex_count()} + topology.edge_count() + f);
    clear(target);
    const double weight = 1.0 / topology.face_size(f);
    for (Index h = topology.face_begin(f); h < topology.face_end(f); ++h) {
      add<K>(target, 1.0, in[topology.origin(h)], columns);
    }
    for (int c = 0; c < (K > 0 ? K : columns); ++c) target[c] *= weight;
  }

  /// What stands across the edge on the side of half-edge h: the centroid's row, or Loop's opposite vertex.
  const double* across(Index h) const {
    if (scheme.kind == SchemeKind::Loop) return in[topology.origin(topology.previous(h))];
    return row(std::ptrdiff_t{topology.vertex_count()} + topology.edge_count() + topology.face(h));
  }

  /// Weight of the crease mask in an edge point: 1 when sharp, fading with the last fraction of sharpness.
  double sharp_weight(Index e) const {
    const float sharpness = topology.edge_sharpness(e);
    if (!is_sharp(sharpness)) return 0.0;
    if (sharpness >= 1.0F) return 1.0;
    const bool stays = is_sharp(child.edge_sharpness(2 * e)) && is_sharp(child.edge_sharpness(2 * e + 1));
    return stays ? 1.0 : sharpness;
  }

  void edge_point(Index e) const {
    const Index h = topology.edge_half_edge(e);
    double* target = row(std::ptrdiff_t{topology.vertex_count()} + e);
    clear(target);
    const double sharp = sharp_weight(e);
    EdgeMask mask{0.5, 0.0};
    if (sharp < 1.0) {
      const Index twin = topology.twin(h);
      const int triangles =
          (topology.face_size(topology.face(h)) == 3 ? 1 : 0) + (topology.face_size(topology.face(twin)) == 3 ? 1 : 0);
      const EdgeMask smooth = edge_mask(scheme, triangles);
      mask = {sharp * 0.5 + (1.0 - sharp) * smooth.end, (1.0 - sharp) * smooth.face};
      add<K>(target, mask.face, across(h), columns);
      add<K>(target, mask.face, across(twin), columns);
    }
    add<K>(target, mask.end, in[topology.origin(h)], columns);
    add<K>(target, mask.end, in[topology.destination(h)], columns);
  }

  void add_smooth(Index v, double weight, double alpha, double* target) const {
    const bool quads = scheme.kind == SchemeKind::CatmullClark;
    int valence = 0;
    topology.for_each_outgoing(v, [&](Index /*h*/) { ++valence; });
    const SmoothMask mask = vertex_mask(scheme.kind, valence, alpha);
    topology.for_each_outgoing(v, [&](Index h) {
      add<K>(target, weight * mask.edge, in[topology.destination(h)], columns);
      if (quads) add<K>(target, weight * mask.face, across(h), columns);
    });
    add<K>(target, weight * mask.vertex, in[v], columns);
  }

  void vertex_point(Index v, double alpha, bool untagged, VertexRing& ring) const {
    double* target = row(v);
    clear(target);
    if (topology.is_isolated(v)) return add<K>(target, 1.0, in[v], columns);
    if (untagged && !topology.is_boundary_vertex(v)) return add_smooth(v, 1.0, alpha, target);
    const VertexBlend blend = vertex_blend(topology, scheme, v, ring);
    if (blend.smooth > 0.0) add_smooth(v, blend.smooth, alpha, target);
    if (blend.crease > 0.0) {
      add<K>(target, blend.crease * kCreaseNeighbour, in[blend.crease_a], columns);
      add<K>(target, blend.crease * kCreaseNeighbour, in[blend.crease_b], columns);
    }
    add<K>(target, blend.crease * kCreaseVertex + blend.corner, in[v], columns);
  }
};

void check_alpha(double alpha) {
  if (alpha >= 0.0 && alpha <= 1.0) return;
  throw Error(ErrorCode::BadArgument, "alpha must lie in [0, 1], but is " + std::to_string(alpha));
}

}  // namespace

Refinement::Refinement(const Topology& topology, const Scheme& scheme, std::vector<double> vertex_alpha,
                       const Progress& progress)
    : topology_(topology),
      scheme_(scheme),
      vertex_alpha_(std::move(vertex_alpha)),
      child_(child_topology(topology, scheme, progress)) {
  check_alpha(scheme.alpha);
  for (const double alpha : vertex_alpha_) check_alpha(alpha);
  if (!vertex_alpha_.empty() && static_cast<Index>(vertex_alpha_.size()) != topology.vertex_count()) {
    throw Error(ErrorCode::BadShape, "vertex_alpha must have one entry a vertex");
  }
}

template <int K>
void Refinement::apply_columns(const double* in, std::ptrdiff_t stride, Values& out, const Progress& progress) const {
  const auto columns = static_cast<int>(out.cols());
  const Step<K> step{topology_, child_, scheme_, Rows<K>(in, stride, columns), out.data(), columns};
  const bool untagged = is_untagged(topology_);
  const auto face_points = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) step.face_point(f);
  };
  const auto edge_points = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto e = static_cast<Index>(begin); e < end; ++e) step.edge_point(e);
  };
  const auto vertex_points = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    VertexRing ring;
    for (auto v = static_cast<Index>(begin); v < end; ++v) step.vertex_point(v, alpha(v), untagged, ring);
  };
  if (scheme_.kind == SchemeKind::CatmullClark) {
    parallel_for(topology_.face_count(), face_points, kDefaultBlock, progress_within(progress, 0.0, 0.2));
  }
  parallel_for(topology_.edge_count(), edge_points, kDefaultBlock, progress_within(progress, 0.2, 0.6));
  parallel_for(topology_.vertex_count(), vertex_points, kDefaultBlock, progress_within(progress, 0.6, 1.0));
}

Values Refinement::apply(ConstValuesRef values, const Progress& progress) const {
  require_vertex_rows(topology_, values);
  Values out(child_.vertex_count(), values.cols());
  if (out.size() == 0) return out;
  if (values.cols() == 3) {
    apply_columns<3>(values.data(), values.outerStride(), out, progress);
  } else {
    apply_columns<0>(values.data(), values.outerStride(), out, progress);
  }
  return out;
}

RefinedSurface refine(const Topology& topology, const Scheme& scheme, ConstValuesRef values, int levels,
                      const Progress& progress) {
  if (levels < 0) throw Error(ErrorCode::BadArgument, "levels must not be negative");
  RefinedSurface surface{topology, values};
  Scheme step_scheme = scheme;
  for (int level = 0; level < levels; ++level) {
    // Each level takes four times as long as the one before.
    const double begin = level == 0 ? 0.0 : std::pow(0.25, levels - level);
    const double end = std::pow(0.25, levels - level - 1);
    const double middle = 0.5 * (begin + end);
    Refinement step(surface.topology, step_scheme, {}, progress_within(progress, begin, middle));
    surface.values = step.apply(surface.values, progress_within(progress, middle, end));
    surface.topology = std::move(step).child();
    step_scheme = scheme.after_first_step();
  }
  return surface;
}

Scheme choose_scheme(const Mesh& mesh) {
  Scheme scheme;
  scheme.kind = mesh.scheme.value_or(all_triangles(mesh) ? SchemeKind::Loop : SchemeKind::CatmullClark);
  scheme.boundary = mesh.boundary.value_or(scheme.boundary);
  scheme.crease_method = mesh.crease_method.value_or(scheme.crease_method);
  scheme.triangle_rule = mesh.triangle_rule.value_or(scheme.triangle_rule);
  return scheme;
}

void state_scheme(const Scheme& scheme, Mesh& mesh) {
  mesh.scheme = scheme.kind;
  mesh.boundary = scheme.boundary;
  if (!mesh.creases.empty()) mesh.crease_method = scheme.crease_method;
  if (scheme.triangle_rule == TriangleRule::Smooth) mesh.triangle_rule = scheme.triangle_rule;
}

Buffer<std::uint8_t> surface_holes(const Topology& topology, const Scheme& scheme) {
  Buffer<std::uint8_t> holes = topology.tables().holes;
  if (scheme.boundary != BoundaryRule::None) return holes;
  holes.resize(static_cast<std::size_t>(topology.face_count()), 0);
  const auto tagged_sharp = [&](Index e) {
    return topology.has_creases() && is_infinite(topology.tables().edge_sharpness[e]);
  };
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (topology.is_isolated(v) || !topology.is_boundary_vertex(v)) continue;
    VertexRing ring;
    gather_ring(topology, v, ring);
    if (tagged_sharp(ring.edges.front()) && tagged_sharp(ring.edges.back())) continue;
    topology.for_each_outgoing(v, [&](Index h) { holes[topology.face(h)] = 1; });
  }
  return holes;
}

Topology with_surface_holes(const Topology& topology, const Scheme& scheme) {
  TopologyTables tables = topology.tables();
  tables.holes = surface_holes(topology, scheme);
  return Topology::from_tables(std::move(tables));
}

}  // namespace batten
