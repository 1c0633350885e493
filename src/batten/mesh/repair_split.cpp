/// Edges of many faces, orientation and fans: all follow from which sides are paired.
#include <algorithm>

#include "batten/mesh/repair_draft.h"

namespace batten {

namespace {

using Side = SideTable::Side;

/// Sets of corners that are one vertex: the corners of faces that are connected around it.
DisjointSets fans(const Draft& draft, const SideTable& sides, const SidePairs& pairs) {
  DisjointSets sets(draft.vertices.size());
  for (Index a = 0; a < sides.corner_count(); ++a) {
    const Index b = pairs.partner[a];
    if (b < a) continue;
    const bool same_way = sides.from(a) == sides.from(b);
    sets.join(a, same_way ? b : sides.next(b));
    sets.join(sides.next(a), same_way ? sides.next(b) : b);
  }
  return sets;
}

/// Pairs the faces at edges of more than two faces.
class CrowdedEdges {
 public:
  explicit CrowdedEdges(const SideTable& sides) : sides_(sides) {
    sides.for_each_edge([&](const Side* first, const Side* last) {
      if (last - first > 2) edges_.emplace_back(first, last);
    });
  }
  bool empty() const { return edges_.empty(); }

  void log(const Draft& draft, RepairLog& log) const {
    for (const auto& edge : edges_) {
      const Index side = edge.first->corner;
      log.add_edge(draft.source(sides_.from(side)), draft.source(sides_.to(side)), RepairKind::SplitEdges);
    }
  }

  void match(const Draft& draft, const Orientation& orientation, SidePairs& pairs) const {
    for (const auto& edge : edges_) {
      const Index start = std::min(sides_.from(edge.first->corner), sides_.to(edge.first->corner));
      const Index end = std::max(sides_.from(edge.first->corner), sides_.to(edge.first->corner));
      std::vector<EdgeFace> faces;
      for (const Side* side = edge.first; side != edge.second; ++side) {
        faces.push_back(draft.edge_face(side->corner, sides_, orientation, sides_.from(side->corner) == start));
      }
      for (const auto& pair : match_sheets(draft.point(end) - draft.point(start), faces)) {
        pairs.join(pair.first, pair.second, sides_.from(pair.first) == sides_.from(pair.second));
      }
    }
  }

  /// Separates pairs whose edges would end in the same two vertices. One round is enough, since each separated fan has
  /// one outgoing and one incoming side. Returns true if there were any.
  bool part_doubled(DisjointSets& fans, SidePairs& pairs) const {
    bool any = false;
    for (const auto& edge : edges_) {
      std::vector<Side> ends;
      for (const Side* side = edge.first; side != edge.second; ++side) {
        const Index corner = side->corner;
        ends.push_back({SideTable::edge_key(fans.root(corner), fans.root(sides_.next(corner))), corner});
      }
      std::sort(ends.begin(), ends.end());
      for (std::size_t i = 0; i < ends.size();) {
        std::size_t j = i + 1;
        while (j < ends.size() && ends[j].edge == ends[i].edge) ++j;
        if (j - i > 2) {
          any = true;
          for (std::size_t k = i; k < j; ++k) pairs.part(ends[k].corner);
        }
        i = j;
      }
    }
    return any;
  }

 private:
  const SideTable& sides_;
  std::vector<std::pair<const Side*, const Side*>> edges_;
};

/// Gives the corners of each fan one vertex: the first fan of a vertex keeps it, the others get copies.
void number_fans(Draft& draft, DisjointSets& fans) {
  const auto corner_count = static_cast<Index>(draft.vertices.size());
  Buffer<std::uint8_t> taken(draft.vertex_sources.size(), 0);
  std::vector<std::pair<Index, Index>> further;  // vertex, then first corner
  Buffer<Index> of_root(draft.vertices.size());
  for (Index c = 0; c < corner_count; ++c) {
    if (fans.root(c) != c) continue;
    const Index v = draft.vertices[c];
    of_root[c] = v;
    if (taken[v] != 0) further.emplace_back(v, c);
    taken[v] = 1;
  }
  std::sort(further.begin(), further.end());
  for (const auto& fan : further) {
    of_root[fan.second] = draft.vertex_count();
    draft.vertex_sources.push_back(draft.vertex_sources[fan.first]);
  }
  for (Index c = 0; c < corner_count; ++c) draft.vertices[c] = of_root[fans.root(c)];
}

}  // namespace

void split(Draft& draft, RepairLog& log) {
  const SideTable sides(draft.offsets, draft.vertices);
  SidePairs pairs = pair_sides(sides);
  Orientation orientation = orient(sides, pairs);
  for (const Index side : orientation.conflicts) {
    log.add_edge(draft.source(sides.from(side)), draft.source(sides.to(side)), RepairKind::CutEdges);
    pairs.part(side);
  }
  const CrowdedEdges crowded(sides);
  crowded.log(draft, log);
  crowded.match(draft, orientation, pairs);
  DisjointSets sets = fans(draft, sides, pairs);
  if (crowded.part_doubled(sets, pairs)) sets = fans(draft, sides, pairs);
  number_fans(draft, sets);
  draft.reverse(orientation.reversed);
}

void turn_outwards(Draft& draft) {
  if (std::find(draft.reversed.begin(), draft.reversed.end(), 1) == draft.reversed.end()) return;
  const SideTable sides(draft.offsets, draft.vertices);
  const SidePairs pairs = pair_sides(sides);
  const Orientation pieces = orient(sides, pairs);
  const auto count = static_cast<std::size_t>(pieces.component_count);
  Buffer<std::uint8_t> open(count, 0);
  Buffer<std::uint8_t> touched(count, 0);
  Buffer<Index> first_vertex(count, -1);
  std::vector<double> volume(count, 0.0);
  for (Index c = 0; c < sides.corner_count(); ++c) {
    const Index piece = pieces.component[sides.face(c)];
    if (pairs.partner[c] < 0) open[piece] = 1;
    if (draft.reversed[sides.face(c)] != 0) touched[piece] = 1;
    if (first_vertex[piece] < 0) first_vertex[piece] = draft.vertices[c];
  }
  for (Index f = 0; f < draft.face_count(); ++f) {
    const Index piece = pieces.component[f];
    const Eigen::Vector3d apex = draft.point(draft.vertices[draft.offsets[f]]) - draft.point(first_vertex[piece]);
    if (open[piece] == 0 && touched[piece] != 0) volume[piece] += apex.dot(draft.normal(f));
  }
  Buffer<std::uint8_t> inwards(draft.reversed.size(), 0);
  for (Index f = 0; f < draft.face_count(); ++f) inwards[f] = volume[pieces.component[f]] < 0.0 ? 1 : 0;
  draft.reverse(inwards);
}

}  // namespace batten
