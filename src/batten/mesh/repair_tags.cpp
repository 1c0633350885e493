#include "batten/mesh/repair_tags.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace batten {

namespace {

/// A tag and its place in the output.
struct Placed {
  std::uint64_t place;
  double sharpness;
  Index tag;  ///< its index in the input's list
  Index a;
  Index b;
};

/// Keeps the sharpest of several tags at a place, in the order of the input's tags.
void keep_sharpest(std::vector<Placed>& placed) {
  std::sort(placed.begin(), placed.end(), [](const Placed& x, const Placed& y) {
    return std::make_tuple(x.place, -x.sharpness, x.tag) < std::make_tuple(y.place, -y.sharpness, y.tag);
  });
  placed.erase(
      std::unique(placed.begin(), placed.end(), [](const Placed& x, const Placed& y) { return x.place == y.place; }),
      placed.end());
  std::sort(placed.begin(), placed.end(),
            [](const Placed& x, const Placed& y) { return std::tie(x.tag, x.place) < std::tie(y.tag, y.place); });
}

struct Carrier {
  const Draft& draft;
  const Mesh& input;
  RepairResult& result;
  RepairLog& log;

  Index input_vertex(std::size_t corner) const { return input.face_vertices[draft.corner_sources[corner]]; }

  /// The input's corner whose side contains the output's side.
  Index input_side(Index face, Index corner, Index next) const {
    return draft.corner_sources[draft.reversed[face] != 0 ? next : corner];
  }

  void creases() const {
    std::vector<std::pair<std::uint64_t, Index>> keys;  // the last tag of an edge counts
    std::vector<std::uint8_t> met(input.creases.size(), 0);
    for (std::size_t i = 0; i < input.creases.size(); ++i) {
      const Crease& crease = input.creases[i];
      if (!std::isfinite(crease.sharpness)) continue;
      keys.emplace_back(SideTable::edge_key(crease.a, crease.b), static_cast<Index>(i));
    }
    std::sort(keys.begin(), keys.end());
    std::vector<Placed> placed;
    for (Index f = 0; f < draft.face_count() && !keys.empty(); ++f) {
      for (Index c = draft.offsets[f]; c < draft.offsets[f + 1]; ++c) {
        const Index next = c + 1 == draft.offsets[f + 1] ? draft.offsets[f] : c + 1;
        place_crease(keys, f, c, next, met, placed);
      }
    }
    for (const std::uint8_t once : met) {
      if (once == 0) log.count_tag();
    }
    keep_sharpest(placed);
    for (const Placed& tag : placed) result.mesh.creases.push_back({tag.a, tag.b, tag.sharpness});
  }

  void place_crease(const std::vector<std::pair<std::uint64_t, Index>>& keys, Index face, Index corner, Index next,
                    std::vector<std::uint8_t>& met, std::vector<Placed>& placed) const {
    const Index side = input_side(face, corner, next);
    const Index source = draft.face_sources[face];
    const Index after = side + 1 == input.face_offsets[source + 1] ? input.face_offsets[source] : side + 1;
    const std::uint64_t key = SideTable::edge_key(input.face_vertices[side], input.face_vertices[after]);
    const auto last = std::upper_bound(keys.begin(), keys.end(), std::pair(key, std::numeric_limits<Index>::max()));
    if (last == keys.begin() || std::prev(last)->first != key) return;
    for (auto tag = std::prev(last); tag->first == key; --tag) {
      met[tag->second] = 1;
      if (tag == keys.begin()) break;
    }
    const Crease& crease = input.creases[std::prev(last)->second];
    Index a = result.mesh.face_vertices[corner];
    Index b = result.mesh.face_vertices[next];
    const std::uint64_t place = SideTable::edge_key(a, b);
    if (input_vertex(corner) != crease.a) std::swap(a, b);
    placed.push_back({place, crease.sharpness, std::prev(last)->second, a, b});
  }

  void corners() const {
    Buffer<Index> tag_of(static_cast<std::size_t>(input.vertex_count()), -1);
    for (std::size_t i = 0; i < input.corners.size(); ++i) {
      const Corner& corner = input.corners[i];
      const bool exists = corner.vertex >= 0 && corner.vertex < input.vertex_count();
      if (!exists || !std::isfinite(corner.sharpness) || result.vertex_targets[corner.vertex] < 0) {
        log.count_tag();
      } else {
        tag_of[corner.vertex] = static_cast<Index>(i);
      }
    }
    if (input.corners.empty()) return;
    std::vector<Placed> placed;
    for (std::size_t c = 0; c < draft.vertices.size(); ++c) {
      const Index tag = tag_of[input_vertex(c)];
      if (tag < 0) continue;
      const Index v = result.mesh.face_vertices[c];
      placed.push_back({static_cast<std::uint64_t>(v), input.corners[tag].sharpness, tag, v, v});
    }
    keep_sharpest(placed);
    for (const Placed& tag : placed) result.mesh.corners.push_back({tag.a, tag.sharpness});
  }

  void holes() const {
    for (const Index face : input.holes) {
      const auto range = std::equal_range(draft.face_sources.begin(), draft.face_sources.end(), face);
      if (range.first == range.second) log.count_tag();
      for (auto f = range.first; f != range.second; ++f) {
        result.mesh.holes.push_back(static_cast<Index>(f - draft.face_sources.begin()));
      }
    }
  }

  Index first_face_from(Index input_face) const {
    const auto& sources = draft.face_sources;
    return static_cast<Index>(std::lower_bound(sources.begin(), sources.end(), input_face) - sources.begin());
  }

  /// Groups that lost all their faces are dropped.
  void groups() const {
    for (std::size_t i = 0; i < input.groups.size(); ++i) {
      const Group& group = input.groups[i];
      std::size_t j = i + 1;
      while (j < input.groups.size() && input.groups[j].keyword != group.keyword) ++j;
      const Index end = j < input.groups.size() ? input.groups[j].first_face : input.face_count();
      const Index first = first_face_from(group.first_face);
      const bool lost = group.first_face < end && first == first_face_from(end);
      if (!lost) result.mesh.groups.push_back({group.keyword, group.name, first});
    }
  }

  bool differs_at_corners(const Values& values) const {
    for (std::size_t c = 0; c < draft.vertices.size(); ++c) {
      const Index kept = result.vertex_sources[result.mesh.face_vertices[c]];
      const Index own = input_vertex(c);
      if (kept != own && values.row(kept) != values.row(own)) return true;
    }
    return false;
  }

  void attributes() const {
    for (const Attribute& attribute : input.attributes) {
      // Without corners, the attribute would be read as one at the vertices.
      if (attribute.per_corner() && draft.vertices.empty()) continue;
      Attribute carried{attribute.name, {}, {}};
      const bool seam = attribute.name == "uv" || attribute.name == "normal";
      if (attribute.per_corner() || (seam && differs_at_corners(attribute.values))) {
        carried.values = attribute.values;
        carried.corner_rows.resize(draft.vertices.size());
        for (std::size_t c = 0; c < draft.vertices.size(); ++c) {
          carried.corner_rows[c] =
              attribute.per_corner() ? attribute.corner_rows[draft.corner_sources[c]] : input_vertex(c);
        }
      } else {
        carried.values.resize(static_cast<Eigen::Index>(result.vertex_sources.size()), attribute.values.cols());
        for (std::size_t v = 0; v < result.vertex_sources.size(); ++v) {
          carried.values.row(static_cast<Eigen::Index>(v)) = attribute.values.row(result.vertex_sources[v]);
        }
      }
      result.mesh.attributes.push_back(std::move(carried));
    }
  }
};

}  // namespace

void carry_over(const Draft& draft, RepairResult& result, RepairLog& log) {
  const Mesh& input = draft.input;
  Mesh& mesh = result.mesh;
  mesh.points.resize(static_cast<Eigen::Index>(result.vertex_sources.size()), 3);
  for (std::size_t v = 0; v < result.vertex_sources.size(); ++v) {
    mesh.points.row(static_cast<Eigen::Index>(v)) = input.points.row(result.vertex_sources[v]);
  }
  const Carrier carrier{draft, input, result, log};
  carrier.creases();
  carrier.corners();
  carrier.holes();
  carrier.groups();
  carrier.attributes();
  mesh.material_libraries = input.material_libraries;
  mesh.scheme = input.scheme;
  mesh.boundary = input.boundary;
  mesh.crease_method = input.crease_method;
  mesh.triangle_rule = input.triangle_rule;
  mesh.face_varying = input.face_varying;
}

}  // namespace batten
