/// Welding: open edges that coincide become one edge, and their vertices are joined.
#include <algorithm>

#include "batten/mesh/places.h"
#include "batten/mesh/repair_draft.h"
#include "batten/mesh/repeated_faces.h"

namespace batten {

using Side = SideTable::Side;

Rim::Rim(const Draft& draft, double tolerance)
    : sides(draft.offsets, draft.vertices), pairs(pair_sides(sides)), places(draft.vertex_sources.size(), -1) {
  for (Index c = 0; c < sides.corner_count(); ++c) {
    if (pairs.partner[c] >= 0) continue;
    open.push_back(c);
    places[sides.from(c)] = places[sides.to(c)] = 0;
  }
  Buffer<Index> vertices;
  Buffer<Index> rows;
  for (Index v = 0; v < draft.vertex_count(); ++v) {
    if (places[v] < 0) continue;
    vertices.push_back(v);
    rows.push_back(draft.source(v));
  }
  const Buffer<Index> numbers = place_numbers(draft.input.points, rows, tolerance);
  for (std::size_t i = 0; i < vertices.size(); ++i) places[vertices[i]] = numbers[i];
}

namespace {

void join_vertices(Draft& draft, DisjointSets& sets) {
  for (Index& v : draft.vertices) v = sets.root(v);
}

/// Marks single faces that lie on an earlier face, or on a face that is not single.
bool mark_lying_faces(const Draft& draft, const Rim& rim, Buffer<std::uint8_t>& dropped) {
  const auto count = static_cast<std::size_t>(draft.face_count());
  Buffer<std::uint8_t> inside(count, 0);
  Buffer<std::uint8_t> single(count, 1);
  Buffer<Index> names(draft.vertices.size());
  for (Index c = 0; c < rim.sides.corner_count(); ++c) {
    names[c] = rim.places[draft.vertices[c]];
    if (names[c] < 0) inside[rim.sides.face(c)] = 1;
    if (rim.pairs.partner[c] >= 0) single[rim.sides.face(c)] = 0;
  }
  bool any = false;
  for_each_repeated_face(draft.offsets, names, inside, [&](Index first, Index later, bool /*same_direction*/) {
    const Index lying = single[later] != 0 ? later : (single[first] != 0 ? first : -1);
    if (lying < 0 || dropped[first] != 0) return;
    dropped[lying] = 1;
    any = true;
  });
  return any;
}

}  // namespace

bool collapse(Draft& draft, const Rim& rim, RepairLog& log) {
  if (rim.open.empty()) return false;
  Buffer<std::uint8_t> lying(static_cast<std::size_t>(draft.face_count()), 0);
  bool any = mark_lying_faces(draft, rim, lying);
  DisjointSets sets(draft.vertex_sources.size());
  for (const Index side : rim.open) {
    const Index a = rim.sides.from(side);
    const Index b = rim.sides.to(side);
    if (rim.places[a] != rim.places[b]) continue;
    sets.join(a, b);
    any = true;
  }
  if (!any) return false;
  for (Index f = 0; f < draft.face_count(); ++f) {
    if (lying[f] != 0) log.add(RepairKind::RepeatedFaces, draft.face_sources[f]);
  }
  join_vertices(draft, sets);
  draft.drop_faces(lying);
  simplify_faces(draft, log);
  return true;
}

namespace {

/// One round of welding.
class Stitcher {
 public:
  Stitcher(Draft& draft, const Rim& rim) : draft_(draft), rim_(rim), pairs_(rim.pairs) {}

  bool run() {
    gather();
    if (edges_.empty()) return false;
    propose_simple();
    propose_crowded();
    DisjointSets sets = joined();
    if (cancel_clashes(sets)) sets = joined();
    if (!any_stitch()) return false;
    draft_.reverse(orient(rim_.sides, pairs_).reversed);
    join_vertices(draft_, sets);
    return true;
  }

 private:
  Index from_place(Index side) const { return rim_.places[rim_.sides.from(side)]; }
  Index to_place(Index side) const { return rim_.places[rim_.sides.to(side)]; }
  bool is_open(Index side) const { return rim_.pairs.partner[side] < 0; }
  bool is_stitch(Index side) const { return is_open(side) && pairs_.partner[side] >= 0; }
  bool any_stitch() const {
    return std::any_of(rim_.open.begin(), rim_.open.end(), [&](Index s) { return is_stitch(s); });
  }

  /// Collects open sides with the same two places.
  void gather() {
    for (const Index side : rim_.open) {
      if (from_place(side) != to_place(side)) {
        open_.push_back({SideTable::edge_key(from_place(side), to_place(side)), side});
      }
    }
    std::sort(open_.begin(), open_.end());
    for (std::size_t i = 0; i < open_.size();) {
      std::size_t j = i + 1;
      while (j < open_.size() && open_[j].edge == open_[i].edge) ++j;
      if (j - i > 1) edges_.emplace_back(i, j);
      i = j;
    }
  }

  /// True for faces folded flat onto each other, which are two layers and not a seam.
  bool folded(Index a, Index b) const {
    const Eigen::Vector3d start = draft_.point(rim_.sides.from(a));
    const Eigen::Vector3d end = draft_.point(rim_.sides.to(a));
    const EdgeFace first{a, 0, true, draft_.normal(rim_.sides.face(a)), true};
    const bool forward = from_place(a) == from_place(b);
    const EdgeFace second{b, 0, forward, draft_.normal(rim_.sides.face(b)), forward};
    if (first.normal.isZero(0.0) || second.normal.isZero(0.0)) return false;
    return angle_around(end - start, first) == angle_around(end - start, second);
  }

  void stitch(Index a, Index b) {
    if (rim_.sides.face(a) != rim_.sides.face(b) && !folded(a, b)) pairs_.join(a, b, from_place(a) == from_place(b));
  }

  void propose_simple() {
    for (const auto& edge : edges_) {
      if (edge.second - edge.first == 2) stitch(open_[edge.first].corner, open_[edge.first + 1].corner);
    }
    for (const Index side : orient(rim_.sides, pairs_).conflicts) pairs_.part(side);
  }

  void propose_crowded() {
    const Orientation orientation = orient(rim_.sides, pairs_);
    for (const auto& edge : edges_) {
      if (edge.second - edge.first == 2) continue;
      const Index first = open_[edge.first].corner;
      const Index start = from_place(first);
      std::vector<EdgeFace> faces;
      for (std::size_t i = edge.first; i < edge.second; ++i) {
        const Index side = open_[i].corner;
        faces.push_back(draft_.edge_face(side, rim_.sides, orientation, from_place(side) == start));
      }
      const Eigen::Vector3d axis = draft_.point(rim_.sides.to(first)) - draft_.point(rim_.sides.from(first));
      for (const auto& pair : match_sheets(axis, faces)) stitch(pair.first, pair.second);
    }
  }

  DisjointSets joined() const {
    DisjointSets sets(draft_.vertex_sources.size());
    for (const Index a : rim_.open) {
      const Index b = pairs_.partner[a];
      if (b < a) continue;
      const bool same_way = pairs_.same_way[a] != 0;
      sets.join(rim_.sides.from(a), same_way ? rim_.sides.from(b) : rim_.sides.to(b));
      sets.join(rim_.sides.to(a), same_way ? rim_.sides.to(b) : rim_.sides.from(b));
    }
    return sets;
  }

  /// Cancels welding at vertices where it would join several edges or make a face touch itself. One round is enough,
  /// since the remaining welds are a subset of those requested.
  bool cancel_clashes(DisjointSets& sets) {
    Buffer<std::uint8_t> clashing(draft_.vertex_sources.size(), 0);  // by set
    Buffer<std::uint8_t> merged(draft_.vertex_sources.size(), 0);    // by set
    for (const Index side : rim_.open) {
      const Index v = rim_.sides.from(side);
      if (sets.root(v) != v) merged[sets.root(v)] = 1;
    }
    std::vector<Side> ends;
    for (Index c = 0; c < rim_.sides.corner_count(); ++c) {
      const Index a = sets.root(rim_.sides.from(c));
      const Index b = sets.root(rim_.sides.to(c));
      if (merged[a] != 0 || merged[b] != 0) ends.push_back({SideTable::edge_key(a, b), c});
    }
    std::sort(ends.begin(), ends.end());
    for (std::size_t i = 0; i < ends.size();) {
      std::size_t j = i + 1;
      while (j < ends.size() && ends[j].edge == ends[i].edge) ++j;
      const Index a = sets.root(rim_.sides.from(ends[i].corner));
      const Index b = sets.root(rim_.sides.to(ends[i].corner));
      if (j - i > 2 || a == b) clashing[a] = clashing[b] = 1;
      i = j;
    }
    mark_faces_that_touch_themselves(sets, merged, clashing);
    bool any = false;
    for (const Index side : rim_.open) {
      const bool clash =
          clashing[sets.root(rim_.sides.from(side))] != 0 || clashing[sets.root(rim_.sides.to(side))] != 0;
      if (!clash || !is_stitch(side)) continue;
      pairs_.part(side);
      any = true;
    }
    return any;
  }

  void mark_faces_that_touch_themselves(DisjointSets& sets, const Buffer<std::uint8_t>& merged,
                                        Buffer<std::uint8_t>& clashing) const {
    Buffer<Index> roots;
    for (Index f = 0; f < draft_.face_count(); ++f) {
      roots.clear();
      for (Index c = draft_.offsets[f]; c < draft_.offsets[f + 1]; ++c) {
        const Index root = sets.root(draft_.vertices[c]);
        if (merged[root] != 0) roots.push_back(root);
      }
      if (roots.size() < 2) continue;
      std::sort(roots.begin(), roots.end());
      for (std::size_t i = 1; i < roots.size(); ++i) {
        if (roots[i] == roots[i - 1]) clashing[roots[i]] = 1;
      }
    }
  }

  Draft& draft_;
  const Rim& rim_;
  SidePairs pairs_;  ///< the pairs of the rim and of the stitches
  std::vector<Side> open_;
  std::vector<std::pair<std::size_t, std::size_t>> edges_;
};

}  // namespace

bool stitch(Draft& draft, const Rim& rim) { return !rim.open.empty() && Stitcher(draft, rim).run(); }

}  // namespace batten
