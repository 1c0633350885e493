#include "batten/limit/vertex_frames.h"

#include <algorithm>

namespace batten {

namespace {

constexpr int kUsualValences = 32;
/// Tangents that span a smaller area, in squares of the ring's extent, have no normal that rounding leaves digits of.
constexpr double kParallel = 1e-9;

/// A smooth vertex inside an untagged mesh.
RingRules smooth_rules(SchemeKind kind, int valence) {
  RingRules rules;
  rules.kind = kind;
  rules.sharpness.assign(static_cast<std::size_t>(valence), 0.0F);
  rules.outer_sharpness = rules.sharpness;
  return rules;
}

/// Relative to the first vertex, so that a mesh far from the origin loses fewer digits.
Eigen::Vector3d apply_mask(const RingMask& mask, const std::vector<Index>& vertices, ConstValuesRef control) {
  const double* origin = control.data() + vertices[0] * control.outerStride();
  double sum[3] = {0.0, 0.0, 0.0};
  const auto add = [&](double weight, std::size_t place) {
    const double* point = control.data() + vertices[place] * control.outerStride();
    for (int c = 0; c < 3; ++c) sum[c] += weight * (point[c] - origin[c]);
  };
  for (std::size_t j = 0; j < mask.edges.size(); ++j) add(mask.edges[j], 1 + j);
  // Loop's rings have no vertices across faces.
  const std::size_t faces = vertices.size() - 1 - mask.edges.size();
  for (std::size_t j = 0; j < faces; ++j) add(mask.faces[j], 1 + mask.edges.size() + j);
  return {sum[0], sum[1], sum[2]};
}

double squared_extent(const std::vector<Index>& vertices, ConstValuesRef control) {
  double most = 0.0;
  for (const Index v : vertices) most = std::max(most, (control.row(v) - control.row(vertices[0])).squaredNorm());
  return most;
}

}  // namespace

VertexFrames::VertexFrames(const Topology& topology, const Scheme& scheme)
    : topology_(topology), scheme_(scheme), is_plain_(is_untagged(topology) && !topology.has_holes()) {
  for (int n = 0; n <= kUsualValences; ++n) {
    smooth_.push_back({n < 3 ? FrameKind::ValenceTwo : FrameKind::Interior, {}, {}});
    if (n < 2) continue;
    smooth_.back().position = limit_position_mask(smooth_rules(scheme.kind, n), LimitMasks::Exact);
    if (n > 2) smooth_.back().tangents = smooth_tangents(scheme.kind, n);
  }
}

/// False at a boundary.
bool VertexFrames::gather_closed(Index vertex, std::vector<Index>& vertices) const {
  const Index size = topology_.uniform_face_size();
  const Index start = topology_.vertex_half_edge(vertex);
  Index across[kUsualValences];
  int count = 0;
  for (Index h = start; h >= 0 && count < kUsualValences;) {
    const Index first = h - h % size;
    const auto after = [&](Index steps) { return first + (h - first + steps) % size; };
    vertices.push_back(topology_.origin(after(1)));
    across[count++] = topology_.origin(after(2));
    h = topology_.twin(after(size - 1));
    if (h != start) continue;
    if (size == 4) vertices.insert(vertices.end(), across, across + count);
    return true;
  }
  return false;
}

/// Any vertex with faces.
void VertexFrames::find_tagged(Index vertex, FrameRing& ring) const {
  const RingRules rules = ring_rules(topology_, scheme_, 0.0, vertex, ring.around);
  const VertexRing& around = ring.around;
  ring.vertices.resize(1);
  ring.vertices.insert(ring.vertices.end(), around.neighbours.begin(), around.neighbours.end());
  if (scheme_.kind == SchemeKind::CatmullClark) {
    for (const Index h : around.corners) ring.vertices.push_back(topology_.origin(topology_.next(topology_.next(h))));
  }
  if (std::all_of(around.corners.begin(), around.corners.end(),
                  [&](Index h) { return topology_.is_hole(topology_.face(h)); })) {
    return;
  }
  ring.masks = &ring.own;
  ring.own.position = limit_position_mask(rules, LimitMasks::Exact);
  std::vector<RingSector> sectors = limit_sectors(rules, LimitMasks::Exact);
  ring.own.kind = rules.closed ? FrameKind::Interior : FrameKind::Boundary;
  if (ring.own.position.vertex == 1.0) {
    ring.own.kind = FrameKind::Corner;
  } else if (rules.closed && rules.edge_count() == 2) {
    ring.own.kind = FrameKind::ValenceTwo;
  } else if (sectors.size() > 1) {
    ring.own.kind = FrameKind::Crease;
  } else {
    ring.own.tangents = std::move(sectors.front().tangents);
  }
}

void VertexFrames::find(Index vertex, FrameRing& ring) const {
  ring.masks = nullptr;
  ring.vertices.assign(1, vertex);
  if (topology_.is_isolated(vertex)) return;
  if (!is_plain_ || !gather_closed(vertex, ring.vertices)) return find_tagged(vertex, ring);
  const std::size_t entries = ring.vertices.size() - 1;
  ring.masks = &smooth_[topology_.uniform_face_size() == 4 ? entries / 2 : entries];
}

VertexFrame VertexFrames::frame(ConstValuesRef control, const FrameRing& ring) {
  VertexFrame frame;
  if (ring.masks == nullptr) return frame;
  const FrameMasks& masks = *ring.masks;
  frame.kind = masks.kind;
  frame.position = control.row(ring.vertices[0]).transpose() + apply_mask(masks.position, ring.vertices, control);
  if (frame.kind != FrameKind::Interior && frame.kind != FrameKind::Boundary) return frame;
  frame.along = apply_mask(masks.tangents.first, ring.vertices, control);
  const Eigen::Vector3d second = apply_mask(masks.tangents.second, ring.vertices, control);
  const Eigen::Vector3d cross = frame.along.cross(second);
  const double length = cross.norm();
  if (length > kParallel * squared_extent(ring.vertices, control)) {
    frame.normal = cross / length;
  } else {
    frame.kind = FrameKind::Degenerate;
  }
  return frame;
}

}  // namespace batten
