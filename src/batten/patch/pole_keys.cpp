#include "batten/patch/pole_keys.h"

#include <algorithm>

#include "batten/patch/face_ring.h"
#include "batten/refine/vertex_blend.h"

namespace batten {

namespace {

/// Rings of fewer are kept (kMostKeptRing), so all of them have to be walked.
constexpr Index kFewestFaces = 512;
/// Faces on each side of a face at its pole that count as near: its other corners' fans reach no farther where valences
/// are 4 or 6.
constexpr int kNear = 4;

}  // namespace

PoleKeys::PoleKeys(const Topology& topology) : topology_(topology) {
  if (!is_untagged(topology)) return;
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (topology.is_isolated(v) || topology.is_boundary_vertex(v)) continue;
    if (topology.vertex_face_count(v) < kFewestFaces) continue;
    Buffer<Index> ring;
    topology.for_each_outgoing(v, [&](Index h) {
      for (Index side = topology.next(h); side != topology.previous(h); side = topology.next(side)) {
        ring.push_back(topology.origin(side));
      }
    });
    std::sort(ring.begin(), ring.end());
    if (std::adjacent_find(ring.begin(), ring.end()) == ring.end()) rings_.emplace(v, std::move(ring));
  }
}

bool PoleKeys::find(Index half_edge, std::string& key) const {
  if (rings_.empty()) return false;
  key = "pole";
  Index at_pole = -1;
  Index h = half_edge;
  const Index size = topology_.face_size(topology_.face(half_edge));
  for (Index c = 0; c < size; ++c, h = topology_.next(h)) {
    if (rings_.count(topology_.origin(h)) == 0) continue;
    if (at_pole >= 0) return false;
    at_pole = h;
    append_bytes(key, c);
  }
  if (at_pole < 0) return false;
  const Index pole = topology_.origin(at_pole);
  const Buffer<Index>& far = rings_.at(pole);
  append_bytes(key, static_cast<Index>(far.size()));
  Numbering vertices;
  const auto add_face = [&](Index start) {
    Index side = start;
    do {
      append_bytes(key, vertices.number(topology_.origin(side)));
      side = topology_.next(side);
    } while (side != start);
  };
  add_face(half_edge);
  h = at_pole;
  for (int i = 0; i < kNear; ++i) add_face(h = topology_.twin(topology_.previous(h)));
  h = at_pole;
  for (int i = 0; i < kNear; ++i) add_face(h = topology_.next(topology_.twin(h)));
  const std::size_t near = vertices.things().size();
  for (Index side = topology_.next(at_pole); side != at_pole; side = topology_.next(side)) {
    const Index corner = topology_.origin(side);
    if (topology_.vertex_face_count(corner) >= kFewestFaces) return false;
    key.push_back(topology_.is_boundary_vertex(corner) ? 'o' : 'c');
    // From the side itself on, and not from where the fan starts, which differs from vertex to vertex.
    Index out = side;
    do {
      add_face(out);
      out = topology_.twin(topology_.previous(out));
    } while (out >= 0 && out != side);
    for (Index t = out < 0 ? topology_.twin(side) : -1; t >= 0; t = topology_.twin(out))
      add_face(out = topology_.next(t));
    key.push_back('.');
  }
  const auto is_far = [&](Index v) { return std::binary_search(far.begin(), far.end(), v); };
  return std::none_of(vertices.things().begin() + static_cast<std::ptrdiff_t>(near), vertices.things().end(), is_far);
}

}  // namespace batten
