#include "batten/refine/refinement.h"

#include <cmath>
#include <string>

#include "batten/error.h"
#include "batten/mesh/checked_values.h"
#include "batten/refine/child_topology.h"
#include "batten/refine/refined_values.h"
#include "batten/refine/vertex_blend.h"

namespace batten {

namespace {

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
  if (!std::isfinite(scheme.tension.value_or(0.0))) {
    throw Error(ErrorCode::BadArgument, "tension must be finite, but is " + std::to_string(*scheme.tension));
  }
  for (const double alpha : vertex_alpha_) check_alpha(alpha);
  if (!vertex_alpha_.empty() && static_cast<Index>(vertex_alpha_.size()) != topology.vertex_count()) {
    throw Error(ErrorCode::BadShape, "vertex_alpha must have one entry a vertex");
  }
}

Values Refinement::apply(ConstValuesRef values, const Progress& progress) const {
  Values result(child_.vertex_count(), values.cols());
  apply_into(values, result, progress);
  return result;
}

void Refinement::apply_into(ConstValuesRef values, ValuesRef result, const Progress& progress) const {
  require_vertex_rows(topology_, values);
  require_shape(result, child_.vertex_count(), values.cols());
  require_finite(values, "values");
  if (result.size() == 0) return;
  if (result.outerStride() == result.cols()) {
    refine_values(topology_, scheme_, vertex_alpha_, values, result.data(), progress);
  } else {
    Values rows(result.rows(), result.cols());
    refine_values(topology_, scheme_, vertex_alpha_, values, rows.data(), progress);
    result = rows;
  }
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
    surface.topology = step.child();
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
  scheme.face_varying = mesh.face_varying.value_or(scheme.face_varying);
  return scheme;
}

void state_scheme(const Scheme& scheme, Mesh& mesh) {
  mesh.scheme = scheme.kind;
  mesh.boundary = scheme.boundary;
  if (!mesh.creases.empty()) mesh.crease_method = scheme.crease_method;
  if (scheme.triangle_rule == TriangleRule::Smooth) mesh.triangle_rule = scheme.triangle_rule;
  if (!scheme.has_linear_corners()) mesh.face_varying = scheme.face_varying;
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
