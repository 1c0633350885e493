#include "batten/patch/face_ring.h"

#include <algorithm>
#include <unordered_map>

#include "batten/refine/vertex_blend.h"

namespace batten {

namespace {

/// Old numbers to new ones, -1 where there is none: a table, or a hash where few of many are asked for.
class Renumbering {
 public:
  Renumbering(Index all, std::size_t few) : dense_(few > static_cast<std::size_t>(all) / 64) {
    if (dense_) table_.assign(static_cast<std::size_t>(all), -1);
  }
  Index operator[](Index old) const {
    if (dense_) return table_[old];
    const auto place = hash_.find(old);
    return place == hash_.end() ? -1 : place->second;
  }
  void set(Index old, Index now) {
    if (dense_) {
      table_[old] = now;
    } else {
      hash_[old] = now;
    }
  }

 private:
  bool dense_;
  Buffer<Index> table_;
  std::unordered_map<Index, Index> hash_;
};

}  // namespace

void Numbering::clear() {
  things_.clear();
  slots_.clear();
}

/// The slot of a thing, or the empty one where it would stand.
std::size_t Numbering::slot_of(Index thing) const {
  constexpr std::uint64_t kSpread = 0x9E3779B97F4A7C15;  // 2^64 over the golden ratio
  constexpr int kHighBits = 32;
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = static_cast<std::size_t>(static_cast<std::uint64_t>(thing) * kSpread >> kHighBits) & mask;
  while (slots_[slot] >= 0 && things_[slots_[slot]] != thing) slot = (slot + 1) & mask;
  return slot;
}

void Numbering::grow() {
  slots_.assign(std::max<std::size_t>(4 * kMostSearched, 4 * slots_.size()), -1);
  while ((slots_.size() & (slots_.size() - 1)) != 0) slots_.push_back(-1);
  for (std::size_t i = 0; i < things_.size(); ++i) slots_[slot_of(things_[i])] = static_cast<Index>(i);
}

Index Numbering::number(Index thing) {
  const auto next = static_cast<Index>(things_.size());
  if (things_.size() < kMostSearched) {
    const auto place = static_cast<Index>(std::find(things_.begin(), things_.end(), thing) - things_.begin());
    if (place == next) things_.push_back(thing);
    return place;
  }
  if (slots_.empty() || 2 * things_.size() >= slots_.size()) grow();
  const std::size_t slot = slot_of(thing);
  if (slots_[slot] >= 0) return slots_[slot];
  slots_[slot] = next;
  things_.push_back(thing);
  return next;
}

void FaceRing::add_face(const Topology& topology, Index half_edge) {
  const Index face = topology.face(half_edge);
  const std::size_t known = starts_.size();
  if (static_cast<std::size_t>(faces_.number(face)) < known) return;
  starts_.push_back(half_edge);
  Index h = half_edge;
  for (Index c = 0; c < topology.face_size(face); ++c, h = topology.next(h)) {
    append_bytes(key_, vertices_.number(topology.origin(h)));
  }
}

/// The faces around the half-edge's origin: counter-clockwise until around, or to the boundary; then clockwise.
bool FaceRing::add_fan(const Topology& topology, Index half_edge, std::size_t most) {
  const auto add_edge = [&](Index edge_half_edge, Index far) {
    const float sharpness = topology.edge_sharpness(topology.edge(edge_half_edge));
    append_bytes(key_, sharpness);
    if (is_semi_sharp(sharpness)) far_ends_.push_back(far);
  };
  Index h = half_edge;
  while (true) {
    const Index p = topology.previous(h);
    add_edge(p, p);
    h = topology.twin(p);
    if (h < 0 || h == half_edge) break;
    add_face(topology, h);
    if (vertices().size() > most) return false;
  }
  key_.push_back(h == half_edge ? 'c' : 'o');
  if (h == half_edge) return true;
  for (Index t = topology.twin(half_edge); t >= 0;) {
    h = topology.next(t);
    add_edge(h, topology.next(h));
    add_face(topology, h);
    if (vertices().size() > most) return false;
    t = topology.twin(h);
  }
  key_.push_back('.');
  return true;
}

void FaceRing::start(const Topology& topology, Index half_edge) {
  vertices_.clear();
  starts_.clear();
  faces_.clear();
  key_.clear();
  far_ends_.clear();
  pole_corner_ = -1;
  add_face(topology, half_edge);
}

/// Chaikin's rule looks at all edges at both ends of a semi-sharp edge.
bool FaceRing::add_far_fans(const Topology& topology, const Scheme& scheme, Index size, std::size_t most) {
  if (scheme.crease_method == CreaseMethod::Uniform) return true;
  const Buffer<Index> far_ends = far_ends_;
  for (const Index far : far_ends) {
    const auto own_end = vertices().begin() + size;
    if (std::find(vertices().begin(), own_end, topology.origin(far)) != own_end) continue;
    if (!add_fan(topology, far, most)) return false;
  }
  return true;
}

bool FaceRing::gather(const Topology& topology, const Scheme& scheme, Index half_edge, std::size_t most) {
  start(topology, half_edge);
  const Index size = topology.face_size(topology.face(half_edge));
  Index side = half_edge;
  for (Index c = 0; c < size; ++c, side = topology.next(side)) {
    append_bytes(key_, vertex_sharpness(topology, scheme, topology.origin(side)));
    if (!add_fan(topology, side, most)) return false;
  }
  return add_far_fans(topology, scheme, size, most);
}

void FaceRing::gather(const Topology& topology, const Scheme& scheme, Index half_edge, const Poles& poles, int width) {
  start(topology, half_edge);
  width_ = width;
  const Index size = topology.face_size(topology.face(half_edge));
  Index side = half_edge;
  Index pole_side = -1;
  for (Index c = 0; c < size; ++c, side = topology.next(side)) {
    if (pole_side < 0 && poles.is_pole(topology.origin(side))) {
      pole_side = side;
      pole_corner_ = c;
      key_.push_back('p');
      continue;
    }
    append_bytes(key_, vertex_sharpness(topology, scheme, topology.origin(side)));
    add_fan(topology, side, kAnyNumber);
  }
  add_far_fans(topology, scheme, size, kAnyNumber);
  if (pole_side >= 0) add_pole(topology, pole_side, poles);
}

void FaceRing::add_pole(const Topology& topology, Index half_edge, const Poles& poles) {
  const Index pole = topology.origin(half_edge);
  pole_faces_ = poles.faces(pole);
  append_bytes(key_, pole_faces_);
  family_size_ = key_.size();
  Index left = half_edge;
  Index right = half_edge;
  for (int i = 0; i < width_; ++i) {
    add_face(topology, left = topology.twin(topology.previous(left)));
    add_face(topology, right = topology.next(topology.twin(right)));
  }
  append_bytes(key_, width_);
  points_ = vertices();
  const Index size = topology.face_size(topology.face(half_edge));
  for (Index m = 0; m < poles.means(); ++m) points_.insert(points_.begin() + size + m, poles.first_mean(pole) + m);
}

Cutting cut_out(const Topology& from, const Buffer<Index>& half_edges) {
  TopologyTables tables;
  Buffer<Index> rows;
  const auto corners_of = [&](std::size_t f) { return from.face_size(from.face(half_edges[f])); };
  tables.uniform_face_size = corners_of(0);
  tables.face_offsets = {0};
  for (std::size_t f = 0; f < half_edges.size(); ++f) {
    if (corners_of(f) != tables.uniform_face_size) tables.uniform_face_size = 0;
    tables.face_offsets.push_back(tables.face_offsets.back() + corners_of(f));
  }
  const auto count = static_cast<std::size_t>(tables.face_offsets.back());
  Renumbering new_half_edge(from.half_edge_count(), count);
  tables.origins.resize(count);
  tables.twins.resize(count);
  tables.faces.resize(count);
  tables.edges.resize(count);
  for (std::size_t f = 0; f < half_edges.size(); ++f) {
    Index old = half_edges[f];
    for (Index h = tables.face_offsets[f]; h < tables.face_offsets[f + 1]; ++h, old = from.next(old)) {
      new_half_edge.set(old, h);
    }
  }
  Renumbering new_vertex(from.vertex_count(), count);
  for (std::size_t f = 0; f < half_edges.size(); ++f) {
    Index old = half_edges[f];
    for (Index h = tables.face_offsets[f]; h < tables.face_offsets[f + 1]; ++h, old = from.next(old)) {
      const Index v = from.origin(old);
      if (new_vertex[v] < 0) {
        new_vertex.set(v, static_cast<Index>(rows.size()));
        rows.push_back(v);
        // The fan's own start where it is here; otherwise the vertex lies on the cut, and any half-edge does.
        const Index start = new_half_edge[from.vertex_half_edge(v)];
        tables.vertex_half_edges.push_back(start >= 0 ? start : h);
        if (from.has_corners()) tables.vertex_sharpness.push_back(from.vertex_sharpness(v));
      }
      const Index old_twin = from.twin(old);
      tables.origins[h] = new_vertex[v];
      tables.twins[h] = old_twin < 0 ? -1 : new_half_edge[old_twin];
      tables.faces[h] = static_cast<Index>(f);
      if (tables.twins[h] >= 0 && tables.twins[h] < h) {
        tables.edges[h] = tables.edges[tables.twins[h]];
      } else {
        tables.edges[h] = static_cast<Index>(tables.edge_half_edges.size());
        tables.edge_half_edges.push_back(h);
        if (from.has_creases()) tables.edge_sharpness.push_back(from.tables().edge_sharpness[from.edge(old)]);
      }
    }
  }
  tables.vertex_count = static_cast<Index>(rows.size());
  return {Topology::from_tables(std::move(tables)), std::move(rows)};
}

}  // namespace batten
