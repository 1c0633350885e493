/// \file A base of triangles refined so many times, as a connectivity for rules that walk over half-edges
/// (refine/butterfly_rules.h), without tables: each face is a lattice of triangles, and vertices are numbered as in
/// tessellate/tessellation_layout.h.
#pragma once
#include "batten/refine/butterfly_rules.h"
#include "batten/tessellate/tessellation_layout.h"

namespace batten {

/// What is sharp after some levels: edges and vertices of the base.
struct LatticeTags {
  Buffer<std::uint8_t> sharp_edges;  ///< E
  Buffer<ButterflyVertex> kinds;     ///< V
};
/// Semi-sharp tags `levels` levels on. O(H).
LatticeTags lattice_tags(const Topology& base, const Scheme& scheme, int levels);

/// Whether any tag is semi-sharp: if not, the tags of all levels are the same. O(V + E).
bool tags_fade(const Topology& base);

/// An upright triangle (i, j) has the corners (i, j), (i+1, j), (i, j+1), a turned one (i+1, j+1), (i, j+1), (i+1, j);
/// side s of a triangle runs from its corner s on.
class LatticeWalk {
 public:
  /// A point of a face's lattice; on sides and corners one of several names, the number is the same.
  struct Vertex {
    std::int64_t number;
    Index face;
    Index i;
    Index j;
  };
  /// Side `side` of a triangle.
  struct HalfEdge {
    Index face;
    Index i;
    Index j;
    bool turned;
    int side;
    bool operator==(const HalfEdge&) const = default;
  };

  LatticeWalk(const Topology& base, const TessellationLayout& layout, const LatticeTags& tags)
      : base_(base), layout_(layout), tags_(tags) {}

  Vertex origin(const HalfEdge& h) const {
    const Index i = h.turned ? h.i + 1 - (h.side == 1 ? 1 : 0) : h.i + (h.side == 1 ? 1 : 0);
    const Index j = h.turned ? h.j + 1 - (h.side == 2 ? 1 : 0) : h.j + (h.side == 2 ? 1 : 0);
    return {layout_.number(base_, h.face, i, j), h.face, i, j};
  }
  HalfEdge next(const HalfEdge& h) const { return {h.face, h.i, h.j, h.turned, h.side == 2 ? 0 : h.side + 1}; }
  HalfEdge previous(const HalfEdge& h) const { return {h.face, h.i, h.j, h.turned, h.side == 0 ? 2 : h.side - 1}; }

  HalfEdge twin(const HalfEdge& h) const {
    const Index across = base_side(h);
    if (across >= 0) {
      const Index other = base_.twin(across);
      return on_base(other, layout_.steps - 1 - segment(h));
    }
    if (h.turned) return {h.face, h.i + (h.side == 2 ? 1 : 0), h.j + (h.side == 0 ? 1 : 0), false, h.side};
    return {h.face, h.i - (h.side == 2 ? 1 : 0), h.j - (h.side == 0 ? 1 : 0), true, h.side};
  }
  bool is_sharp(const HalfEdge& h) const {
    const Index across = base_side(h);
    return across >= 0 && tags_.sharp_edges[base_.edge(across)] != 0;
  }
  ButterflyVertex kind(const Vertex& vertex) const {
    if (vertex.number < layout_.edge_start) return tags_.kinds[vertex.number];
    if (vertex.number >= layout_.face_start) return ButterflyVertex::Regular;
    const auto edge = static_cast<Index>((vertex.number - layout_.edge_start) / layout_.per_edge);
    return tags_.sharp_edges[edge] != 0 ? ButterflyVertex::Curve : ButterflyVertex::Regular;
  }

  /// A half-edge from a point into its own face.
  HalfEdge outgoing(Index face, Index i, Index j) const {
    if (i + j < layout_.steps) return {face, i, j, false, 0};
    if (i > 0) return {face, i - 1, j, false, 1};
    return {face, i, j - 1, false, 2};
  }

  /// The half-edge along a base half-edge, so many segments from its origin.
  HalfEdge on_base(Index base_half_edge, Index from_origin) const {
    const Index face = base_.face(base_half_edge);
    const auto side = static_cast<int>(base_half_edge - base_.face_begin(face));
    const Index back = layout_.steps - 1 - from_origin;
    return {face, side == 0 ? from_origin : (side == 1 ? back : 0), side == 0 ? 0 : (side == 1 ? from_origin : back),
            false, side};
  }

 private:
  /// The base half-edge that h is a part of, or -1.
  Index base_side(const HalfEdge& h) const {
    if (h.turned) return -1;
    const bool on = h.side == 0 ? h.j == 0 : (h.side == 1 ? h.i + h.j == layout_.steps - 1 : h.i == 0);
    return on ? base_.face_begin(h.face) + h.side : -1;
  }
  Index segment(const HalfEdge& h) const { return h.side == 0 ? h.i : (h.side == 1 ? h.j : layout_.steps - 1 - h.j); }

  Topology base_;
  const TessellationLayout& layout_;
  const LatticeTags& tags_;
};

}  // namespace batten
