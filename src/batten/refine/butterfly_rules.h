/// \file Which rule makes the new point of an edge under Butterfly and Modified Butterfly.
///
/// The rules walk over half-edges of a connectivity that need not be stored. The type Walk defines it (TopologyWalk
/// does so for a Topology): a HalfEdge type and origin(h), next(h), previous(h), twin(h) (called only where is_sharp(h)
/// is false), is_sharp(h) (tagged at this level, or a boundary) and kind(vertex).
#pragma once
#include <vector>

#include "batten/mesh/topology.h"
#include "batten/scheme/butterfly.h"
#include "batten/scheme/sharpness.h"

namespace batten {

/// The kinds of vertices that the rules distinguish.
enum class ButterflyVertex : std::uint8_t {
  Regular,        ///< six edges, none of them sharp
  Extraordinary,  ///< another number of edges, none of them sharp
  Dart,           ///< one sharp edge, which ends here; smooth otherwise
  Curve,          ///< two sharp edges: a curve passes through
  Corner          ///< curves end here
};

/// The kind of each vertex; vertices without faces are corners. O(H).
Buffer<ButterflyVertex> butterfly_vertices(const Topology& topology, const Scheme& scheme);

/// A walk over a Topology and the kinds of its vertices.
class TopologyWalk {
 public:
  using HalfEdge = Index;

  TopologyWalk(const Topology& topology, const Buffer<ButterflyVertex>& kinds) : topology_(topology), kinds_(kinds) {}

  Index origin(Index h) const { return topology_.origin(h); }
  Index next(Index h) const { return topology_.next(h); }
  Index previous(Index h) const { return topology_.previous(h); }
  Index twin(Index h) const { return topology_.twin(h); }
  bool is_sharp(Index h) const {
    return topology_.twin(h) < 0 || (topology_.has_creases() && batten::is_sharp(topology_.edge_sharpness(edge(h))));
  }
  ButterflyVertex kind(Index vertex) const { return kinds_[vertex]; }

 private:
  Index edge(Index h) const { return topology_.edge(h); }

  const Topology& topology_;
  const Buffer<ButterflyVertex>& kinds_;
};

/// The rule at an edge. O(valence) where an end is extraordinary, O(1) otherwise.
template <typename Walk>
class ButterflyRules {
 public:
  using HalfEdge = typename Walk::HalfEdge;

  ButterflyRules(const Walk& walk, const ButterflyMasks& masks) : walk_(walk), masks_(masks) {}

  /// Calls visit(vertex, weight) for each term of the new point of h's edge. A vertex may be visited several times.
  template <typename Visit>
  void visit(HalfEdge h, const Visit& visit) const {
    if (walk_.is_sharp(h)) return visit_curve(h, visit);
    if (masks_.is_modified() && visit_ends(h, visit)) return;
    if (visit_corner(h, visit)) return;
    visit_stencil(h, visit);
  }

  /// The vertex on the curve after h's end, or before h's origin. Requires ButterflyVertex::Curve there.
  auto after(HalfEdge h) const {
    HalfEdge g = walk_.next(h);
    while (!walk_.is_sharp(g)) g = walk_.next(walk_.twin(g));
    return destination(g);
  }
  auto before(HalfEdge h) const {
    HalfEdge g = walk_.previous(h);
    while (!walk_.is_sharp(g)) g = walk_.previous(walk_.twin(g));
    return walk_.origin(g);
  }

  /// Calls visit(g) for the outgoing half-edges at h's origin, counter-clockwise from h. The origin must not be on a
  /// boundary.
  template <typename Visit>
  void turn_around(HalfEdge h, const Visit& visit) const {
    HalfEdge g = h;
    do {
      visit(g);
      g = walk_.twin(walk_.previous(g));
    } while (!(g == h));
  }

 private:
  /// The wings in this order: left of h at its origin, left of h at its end, then the two on its right.
  struct Wings {
    bool there[4];
    HalfEdge across[4];  ///< the side across which the wing lies, in the triangle at h
  };

  auto destination(HalfEdge h) const { return walk_.origin(walk_.next(h)); }
  auto opposite(HalfEdge h) const { return walk_.origin(walk_.previous(h)); }
  /// The vertex in line with h before its origin, which must be regular.
  auto beyond(HalfEdge h) const {
    HalfEdge g = h;
    for (int i = 0; i < 3; ++i) g = walk_.twin(walk_.previous(g));
    return destination(g);
  }

  template <typename Visit>
  void visit_curve(HalfEdge h, const Visit& visit) const {
    const auto from = walk_.origin(h);
    const auto to = destination(h);
    const bool has_before = walk_.kind(from) == ButterflyVertex::Curve;
    const bool has_after = walk_.kind(to) == ButterflyVertex::Curve;
    const CurveEndMask& end = masks_.curve_end();
    if (has_before && has_after) {
      visit(from, kFourPointNear);
      visit(to, kFourPointNear);
      visit(before(h), kFourPointFar);
      visit(after(h), kFourPointFar);
    } else if (has_after) {
      visit(from, end.end);
      visit(to, end.other);
      visit(after(h), end.after);
    } else if (has_before) {
      visit(to, end.end);
      visit(from, end.other);
      visit(before(h), end.after);
    } else {
      visit(from, 0.5);
      visit(to, 0.5);
    }
  }

  /// Applies the rules of extraordinary ends, averaged where both ends have one. Returns false where neither has one.
  template <typename Visit>
  bool visit_ends(HalfEdge h, const Visit& visit) const {
    const HalfEdge t = walk_.twin(h);
    const bool from = is_extraordinary(h);
    const bool to = is_extraordinary(t);
    const double share = from && to ? 0.5 : 1.0;
    if (from) visit_ring(h, share, visit);
    if (to) visit_ring(t, share, visit);
    if (from || to) return true;
    if (masks_.boundary() == ButterflyBoundary::Reflect) return false;
    const Span here = span(h);
    const Span there = span(t);
    const bool here_extraordinary = here.triangles > 0 && here.triangles != 3;
    const bool there_extraordinary = there.triangles > 0 && there.triangles != 3;
    const double half = here_extraordinary && there_extraordinary ? 0.5 : 1.0;
    if (here_extraordinary) visit_span(here, half, visit);
    if (there_extraordinary) visit_span(there, half, visit);
    return here_extraordinary || there_extraordinary;
  }

  /// Applies the rule of an edge at a corner: it keeps its direction there, as a curve that ends. Returns false where
  /// neither end is a corner.
  template <typename Visit>
  bool visit_corner(HalfEdge h, const Visit& visit) const {
    const auto from = walk_.origin(h);
    const auto to = destination(h);
    const bool at_from = walk_.kind(from) == ButterflyVertex::Corner;
    const bool at_to = walk_.kind(to) == ButterflyVertex::Corner;
    if (!at_from && !at_to) return false;
    const HalfEdge toward = at_from ? walk_.twin(h) : h;  // towards the corner
    if (walk_.kind(walk_.origin(toward)) != ButterflyVertex::Regular) {
      visit(from, 0.5);
      visit(to, 0.5);
      return true;
    }
    const CurveEndMask& end = masks_.curve_end();
    visit(destination(toward), end.end);
    visit(walk_.origin(toward), end.other);
    visit(beyond(toward), end.after);
    return true;
  }

  bool is_extraordinary(HalfEdge h) const {
    const ButterflyVertex kind = walk_.kind(walk_.origin(h));
    if (kind == ButterflyVertex::Extraordinary) return true;
    return kind == ButterflyVertex::Dart && valence(h) != 6;
  }

  int valence(HalfEdge h) const {
    int count = 0;
    turn_around(h, [&](HalfEdge) { ++count; });
    return count;
  }

  template <typename Visit>
  void visit_ring(HalfEdge h, double share, const Visit& visit) const {
    RingMask scratch;
    const RingMask& mask = masks_.extraordinary(valence(h), scratch);
    visit(walk_.origin(h), share * mask.vertex);
    std::size_t j = 0;
    turn_around(h, [&](HalfEdge g) { visit(destination(g), share * mask.edges[j++]); });
  }

  /// The triangles between two sharp edges at a vertex of a curve.
  struct Span {
    HalfEdge first;     ///< from the vertex along the leading sharp edge
    int triangles = 0;  ///< 0 if no curve passes here
    int edge = 0;       ///< the edge in question, counted from `first`
  };

  Span span(HalfEdge h) const {
    Span found{h};
    if (walk_.kind(walk_.origin(h)) != ButterflyVertex::Curve) return found;
    do {
      found.first = walk_.next(walk_.twin(found.first));
      ++found.edge;
    } while (!walk_.is_sharp(found.first));
    found.triangles = found.edge;
    for (HalfEdge g = h;; ++found.triangles) {
      const HalfEdge p = walk_.previous(g);
      if (walk_.is_sharp(p)) break;
      g = walk_.twin(p);
    }
    ++found.triangles;
    return found;
  }

  template <typename Visit>
  void visit_span(const Span& span, double share, const Visit& visit) const {
    RingMask scratch;
    const RingMask& mask = masks_.crease_vertex(span.triangles, span.edge, scratch);
    visit(walk_.origin(span.first), share * mask.vertex);
    HalfEdge g = span.first;
    for (int j = 0; j < span.triangles; ++j) {
      visit(destination(g), share * mask.edges[j]);
      const HalfEdge p = walk_.previous(g);
      if (j + 1 < span.triangles) {
        g = walk_.twin(p);
      } else {
        visit(walk_.origin(p), share * mask.edges[j + 1]);
      }
    }
  }

  Wings find_wings(HalfEdge h, HalfEdge t) const {
    Wings wings{{}, {walk_.previous(h), walk_.next(h), walk_.next(t), walk_.previous(t)}};
    for (int i = 0; i < 4; ++i) {
      // The surface is smooth at a dart, so the rules reach across its sharp edge.
      const auto end = i % 2 == 0 ? walk_.origin(h) : walk_.origin(t);
      wings.there[i] = !walk_.is_sharp(wings.across[i]) || walk_.kind(end) == ButterflyVertex::Dart;
    }
    return wings;
  }

  template <typename Visit>
  void visit_stencil(HalfEdge h, const Visit& visit) const {
    const HalfEdge t = walk_.twin(h);
    const Wings wings = find_wings(h, t);
    int missing = 0;
    for (int i = 0; i < 4; ++i) missing |= wings.there[i] ? 0 : 1 << i;
    const bool rules = masks_.boundary() == ButterflyBoundary::CreaseRules;
    switch (rules ? missing : 0) {
      case 1:
        return visit_one_missing(h, t, wings, 0, visit);
      case 2:
        return visit_one_missing(t, h, wings, 1, visit);
      case 4:
        return visit_one_missing(h, t, wings, 2, visit);
      case 8:
        return visit_one_missing(t, h, wings, 3, visit);
      case 1 | 2:
        return visit_side_missing(h, t, wings, 2, visit);
      case 4 | 8:
        return visit_side_missing(t, h, wings, 0, visit);
      case 1 | 8:
      case 2 | 4:  // a strip of width one
        visit(walk_.origin(h), 0.5);
        visit(walk_.origin(t), 0.5);
        return;
      default:
        visit_all(h, t, wings, visit);
    }
  }

  auto wing(const Wings& wings, int i) const { return opposite(walk_.twin(wings.across[i])); }

  /// v: the half-edge from the end at which wing i is missing; x: its twin.
  template <typename Visit>
  void visit_one_missing(HalfEdge v, HalfEdge x, const Wings& wings, int i, const Visit& visit) const {
    constexpr OneWingMissing kMask;
    const bool left = (i < 2) == (i % 2 == 0);  // as seen from v
    visit(walk_.origin(v), kMask.v);
    visit(walk_.origin(x), kMask.x);
    visit(opposite(left ? v : x), kMask.opposite_a);
    visit(opposite(left ? x : v), kMask.opposite_b);
    visit(wing(wings, i ^ 2), kMask.wing_v_b);
    visit(wing(wings, i ^ 1), kMask.wing_x_a);
    visit(wing(wings, i ^ 3), kMask.wing_x_b);
  }

  /// `there`: the first of the two wings that exist, on the right of h.
  template <typename Visit>
  void visit_side_missing(HalfEdge h, HalfEdge t, const Wings& wings, int there, const Visit& visit) const {
    constexpr SideMissing kMask;
    visit(walk_.origin(h), kMask.end);
    visit(walk_.origin(t), kMask.end);
    visit(opposite(t), kMask.opposite_b);
    visit(wing(wings, there), kMask.wing_b);
    visit(wing(wings, there + 1), kMask.wing_b);
  }

  /// Takes the eight or ten points. A missing wing is found by reflection: it is the sum of the ends of the side that
  /// it would lie across, minus the triangle's third vertex.
  template <typename Visit>
  void visit_all(HalfEdge h, HalfEdge t, const Wings& wings, const Visit& visit) const {
    const ButterflyMask& mask = masks_.stencil();
    const auto from = walk_.origin(h);
    const auto to = walk_.origin(t);
    visit(from, mask.end);
    visit(to, mask.end);
    visit(opposite(h), mask.opposite);
    visit(opposite(t), mask.opposite);
    for (int i = 0; i < 4; ++i) {
      if (wings.there[i]) {
        visit(wing(wings, i), mask.wing);
        continue;
      }
      const auto near = i % 2 == 0 ? from : to;
      const auto far = i % 2 == 0 ? to : from;
      visit(near, mask.wing);
      visit(opposite(i < 2 ? h : t), mask.wing);
      visit(far, -mask.wing);
    }
    if (mask.beyond == 0.0) return;
    visit_beyond(h, mask.beyond, visit);
    visit_beyond(t, mask.beyond, visit);
  }

  /// The vertex in line with h before its origin, by reflection where the origin is not regular.
  template <typename Visit>
  void visit_beyond(HalfEdge h, double weight, const Visit& visit) const {
    if (walk_.kind(walk_.origin(h)) != ButterflyVertex::Regular) {
      visit(walk_.origin(h), 2.0 * weight);
      visit(destination(h), -weight);
      return;
    }
    visit(beyond(h), weight);
  }

  const Walk& walk_;
  const ButterflyMasks& masks_;
};

/// The new point of an edge as control points and weights. A vertex may appear several times.
struct ButterflyPoint {
  std::vector<Index> vertices;
  std::vector<double> weights;
};
/// The new point of a single edge. `kinds` are those of butterfly_vertices(). refine_values computes all edges faster.
ButterflyPoint butterfly_point(const Topology& topology, const Buffer<ButterflyVertex>& kinds,
                               const ButterflyMasks& masks, Index edge);

/// The control values of one step: V rows that are kept, then one for each edge. Called by refine_values
/// (refine/refined_values.h).
template <typename Scalar>
void refine_butterfly_values(const Topology& topology, const Scheme& scheme, ConstValuesRef values, Scalar* out,
                             const Progress& progress = {});

}  // namespace batten
