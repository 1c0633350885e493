#include "batten/patch/quad_ring.h"

#include <algorithm>

#include "batten/refine/vertex_blend.h"

namespace batten {

namespace {

// A fan's number: the sharpness of up to eight edges, how many there are, how many before the boundary (0: no
// boundary), the sharpness of the vertex.
constexpr int kSharpnessBits = 6;
constexpr int kCountBits = 4;
constexpr int kEdgesPlace = 8 * kSharpnessBits;
constexpr int kOpenPlace = kEdgesPlace + kCountBits;
constexpr int kVertexPlace = kOpenPlace + kCountBits;

}  // namespace

SharpnessCodes::SharpnessCodes(const Topology& topology) {
  const TopologyTables& tables = topology.tables();
  edges_.resize(tables.edge_sharpness.size());
  for (std::size_t e = 0; e < edges_.size() && complete_; ++e) edges_[e] = intern(tables.edge_sharpness[e]);
  for (std::size_t v = 0; v < tables.vertex_sharpness.size() && complete_; ++v) intern(tables.vertex_sharpness[v]);
}

std::uint8_t SharpnessCodes::of(float sharpness) const {
  if (!is_sharp(sharpness)) return 0;
  if (is_infinite(sharpness)) return 1;
  return static_cast<std::uint8_t>(2 + (std::find(values_.begin(), values_.end(), sharpness) - values_.begin()));
}

std::uint8_t SharpnessCodes::intern(float sharpness) {
  const std::uint8_t code = of(sharpness);
  if (code < 2 + values_.size()) return code;
  values_.push_back(sharpness);
  complete_ = code < kMost;
  return code;
}

QuadRing::QuadRing(const Topology& topology, const Scheme& scheme, const SharpnessCodes& codes)
    : topology_(topology),
      scheme_(scheme),
      codes_(codes),
      possible_(topology.uniform_face_size() == 4 && codes.complete() &&
                !(scheme.crease_method == CreaseMethod::Chaikin && topology.has_creases())) {}

void QuadRing::add_edge(Index half_edge, Fan& fan) const {
  const std::uint64_t code = topology_.twin(half_edge) < 0 ? 1 : codes_.of_edge(topology_.edge(half_edge));
  fan.sharpness |= code << (kSharpnessBits * fan.edges);
  ++fan.edges;
}

/// Counter-clockwise around the origin, until around (then the half-edge itself is returned), to the boundary (-1), or
/// enough. What lies across the face's sides is left to one of their corners.
Index QuadRing::turn_left(Index half_edge, Fan& fan) {
  Index h = half_edge;
  do {
    const Index p = previous(h);
    if (fan.edges > 0 && topology_.twin(p) != half_edge) {
      if (fan.edges > 1) add(previous(p));
      add(p);
    }
    add_edge(p, fan);
    h = topology_.twin(p);
  } while (h >= 0 && h != half_edge && fan.edges < kMostEdges);
  return h;
}

/// Clockwise to the boundary; false where there are too many edges.
bool QuadRing::turn_right(Index half_edge, Fan& fan) {
  const int before = fan.edges;
  for (Index h = half_edge; fan.edges < kMostEdges;) {
    if (fan.edges > before) add(next(h));
    if (fan.edges > before + 1) add(next(next(h)));
    add_edge(h, fan);
    const Index twin = topology_.twin(h);
    if (twin < 0) return true;
    h = next(twin);
  }
  return false;
}

bool QuadRing::gather_fan(Index half_edge, std::uint64_t& code) {
  Fan fan;
  const Index last = turn_left(half_edge, fan);
  const std::uint64_t before_boundary = last < 0 ? static_cast<std::uint64_t>(fan.edges) : 0;
  if (last < 0 ? !turn_right(half_edge, fan) : last != half_edge || fan.edges < 3) return false;
  const float sharpness = vertex_sharpness(topology_, scheme_, topology_.origin(half_edge));
  code = fan.sharpness | static_cast<std::uint64_t>(fan.edges) << kEdgesPlace | before_boundary << kOpenPlace |
         std::uint64_t{codes_.of(sharpness)} << kVertexPlace;
  return true;
}

/// Each vertex is equal to itself; one more equality is one too many.
bool QuadRing::all_different() {
  const int padded = (count_ + kAtOnce - 1) / kAtOnce * kAtOnce;
  std::fill(vertices_.begin() + count_, vertices_.begin() + padded, -1);
  std::array<Index, kAtOnce> equal{};
  for (int i = 0; i < count_; ++i) {
    const Index vertex = vertices_[i];
    for (int block = 0; block < padded; block += kAtOnce) {
      for (int k = 0; k < kAtOnce; ++k) equal[k] += vertices_[block + k] == vertex ? 1 : 0;
    }
  }
  int all = 0;
  for (const Index lane : equal) all += lane;
  return all == count_;
}

bool QuadRing::gather(Index half_edge) {
  count_ = 0;
  if (!possible_) return false;
  Index side = half_edge;
  for (int c = 0; c < 4; ++c, side = next(side)) add(side);
  for (int c = 0; c < 4; ++c, side = next(side)) {
    if (!gather_fan(side, code_[c])) return false;
  }
  return all_different();
}

}  // namespace batten
