#include "batten/fit/local_loop.h"

#include <algorithm>

#include "batten/scheme/masks.h"

namespace batten {

namespace {

/// to += weight * from.
void add_weighted(double weight, const LocalValues& from, LocalValues& to) {
  for (std::size_t c = 0; c < from.size(); ++c) to[c] += weight * from[c];
}

}  // namespace

void find_twins(const std::vector<std::array<Index, 3>>& faces, std::vector<Index>& twins,
                std::vector<std::array<Index, 3>>& work) {
  const std::size_t count = 3 * faces.size();
  twins.assign(count, -1);
  work.resize(count);
  for (std::size_t h = 0; h < count; ++h) {
    const std::array<Index, 3>& face = faces[h / 3];
    const Index a = face[h % 3];
    const Index b = face[(h + 1) % 3];
    work[h] = {std::min(a, b), std::max(a, b), static_cast<Index>(h)};
  }
  std::sort(work.begin(), work.end());
  for (std::size_t i = 0; i + 1 < count; ++i) {
    if (work[i][0] != work[i + 1][0] || work[i][1] != work[i + 1][1]) continue;
    twins[work[i][2]] = work[i + 1][2];
    twins[work[i + 1][2]] = work[i][2];
  }
}

/// The sums that the masks of a vertex are made of.
struct LocalLoop::Ring {
  LocalValues all{};
  LocalValues sharp{};
  int count = 0;
  int sharp_count = 0;
};

LocalLoop::LocalLoop() {
  for (int valence = 3; valence <= kMostValence; ++valence) {
    vertex_weights_[valence] = vertex_mask(SchemeKind::Loop, valence, 0.0).vertex;
    limit_weights_[valence] = limit_mask(SchemeKind::Loop, valence, 0.0).vertex;
  }
}

LocalLoop::Ring LocalLoop::ring_of(const Level& level, Index vertex) const {
  Ring ring;
  const auto take = [&](Index neighbour, bool sharp) {
    add_weighted(1.0, level.values[neighbour], ring.all);
    ++ring.count;
    if (!sharp) return;
    add_weighted(1.0, level.values[neighbour], ring.sharp);
    ++ring.sharp_count;
  };
  const auto end_of = [&](Index h) { return level.faces[next_in_face(h) / 3][next_in_face(h) % 3]; };
  const Index start = level.outgoing[vertex];
  Index h = start;
  do {
    take(end_of(h), level.sharp[h] != 0 || level.twins[h] < 0);
    const Index in = last_in_face(h);
    h = level.twins[in];
    if (h < 0) take(level.faces[in / 3][in % 3], true);
  } while (h >= 0 && h != start && ring.count < kMostValence);
  if (h >= 0) return ring;
  // The other way round from the start, which a boundary may lie behind.
  for (Index twin = level.twins[start]; twin >= 0 && ring.count < kMostValence;) {
    const Index out = next_in_face(twin);
    take(end_of(out), level.sharp[out] != 0 || level.twins[out] < 0);
    twin = level.twins[out];
  }
  return ring;
}

LocalValues LocalLoop::moved_vertex(const Level& level, Index vertex, bool limit) const {
  if (level.outgoing[vertex] < 0) return level.values[vertex];
  const Ring ring = ring_of(level, vertex);
  if (ring.sharp_count > 2) return level.values[vertex];
  LocalValues value{};
  if (ring.sharp_count == 2) {
    add_weighted(limit ? 2.0 / 3.0 : 0.75, level.values[vertex], value);
    add_weighted(limit ? 1.0 / 6.0 : 0.125, ring.sharp, value);
    return value;
  }
  const int valence = std::clamp(ring.count, 3, kMostValence);
  const double own = (limit ? limit_weights_ : vertex_weights_)[valence];
  add_weighted(own, level.values[vertex], value);
  add_weighted((1.0 - own) / ring.count, ring.all, value);
  return value;
}

void LocalLoop::refine_level(const Level& from, Level& to) {
  const auto half_edges = static_cast<Index>(from.twins.size());
  const auto vertices = static_cast<Index>(from.values.size());
  edges_.resize(from.twins.size());
  Index next = vertices;
  for (Index h = 0; h < half_edges; ++h)
    edges_[h] = from.twins[h] >= 0 && from.twins[h] < h ? edges_[from.twins[h]] : next++;
  to.values.resize(static_cast<std::size_t>(next));
  to.outgoing.assign(static_cast<std::size_t>(next), -1);
  for (Index v = 0; v < vertices; ++v) to.values[v] = moved_vertex(from, v, false);
  for (Index h = 0; h < half_edges; ++h) {
    const Index twin = from.twins[h];
    if (twin >= 0 && twin < h) continue;
    const auto corner = [&](Index of) -> const LocalValues& { return from.values[from.faces[of / 3][of % 3]]; };
    LocalValues value{};
    const bool sharp = twin < 0 || from.sharp[h] != 0;
    add_weighted(sharp ? 0.5 : 0.375, corner(h), value);
    add_weighted(sharp ? 0.5 : 0.375, corner(next_in_face(h)), value);
    if (!sharp) {
      add_weighted(0.125, corner(last_in_face(h)), value);
      add_weighted(0.125, corner(last_in_face(twin)), value);
    }
    to.values[edges_[h]] = value;
  }
  const std::size_t faces = from.faces.size();
  to.faces.resize(4 * faces);
  to.twins.resize(12 * faces);
  to.sharp.assign(12 * faces, 0);
  for (Index f = 0; f < static_cast<Index>(faces); ++f) {
    const Index e[3] = {edges_[3 * f], edges_[3 * f + 1], edges_[3 * f + 2]};
    const Index inner = 4 * f + 3;
    to.faces[inner] = {e[0], e[1], e[2]};
    for (int i = 0; i < 3; ++i) {
      const int before = (i + 2) % 3;
      const Index child = 4 * f + i;
      to.faces[child] = {from.faces[f][i], e[i], e[before]};
      // Out along the edge that starts here, in along the one before, and across to the inner child.
      const Index out = from.twins[3 * f + i];
      const Index in = from.twins[3 * f + before];
      to.twins[3 * child] = out < 0 ? -1 : 3 * (4 * (out / 3) + (out % 3 + 1) % 3) + 2;
      to.twins[3 * child + 1] = 3 * inner + before;
      to.twins[3 * child + 2] = in < 0 ? -1 : 3 * (4 * (in / 3) + in % 3);
      to.twins[3 * inner + before] = 3 * child + 1;
      to.sharp[3 * child] = from.sharp[3 * f + i];
      to.sharp[3 * child + 2] = from.sharp[3 * f + before];
      for (int c = 0; c < 3; ++c) to.outgoing[to.faces[child][c]] = 3 * child + c;
    }
  }
}

void LocalLoop::find_limits() {
  limits_.resize(fine_.values.size());
  done_.assign(fine_.values.size(), 0);
  for (Index f = 0; f < facet_count(); ++f) {
    for (const Index v : fine_.faces[f]) {
      if (done_[v] != 0) continue;
      done_[v] = 1;
      limits_[v] = moved_vertex(fine_, v, true);
    }
  }
}

/// Leaves the faces that touch the first `wanted` ones.
void LocalLoop::keep_near(Level& level, std::size_t wanted) {
  done_.assign(level.values.size(), 0);
  for (std::size_t f = 0; f < wanted; ++f) {
    for (const Index v : level.faces[f]) done_[v] = 1;
  }
  number_.assign(level.faces.size(), -1);
  Index kept = 0;
  for (std::size_t f = 0; f < level.faces.size(); ++f) {
    const std::array<Index, 3>& face = level.faces[f];
    if (std::any_of(face.begin(), face.end(), [&](Index v) { return done_[v] != 0; })) number_[f] = kept++;
  }
  level.outgoing.assign(level.values.size(), -1);
  for (std::size_t f = 0; f < level.faces.size(); ++f) {
    if (number_[f] < 0) continue;
    const auto to = static_cast<std::size_t>(number_[f]);
    level.faces[to] = level.faces[f];
    for (std::size_t c = 0; c < 3; ++c) {
      const Index twin = level.twins[3 * f + c];
      const Index face = twin < 0 ? -1 : number_[twin / 3];
      level.twins[3 * to + c] = face < 0 ? -1 : 3 * face + twin % 3;
      level.sharp[3 * to + c] = level.sharp[3 * f + c];
      level.outgoing[level.faces[to][c]] = static_cast<Index>(3 * to + c);
    }
  }
  level.faces.resize(static_cast<std::size_t>(kept));
  level.twins.resize(3 * static_cast<std::size_t>(kept));
  level.sharp.resize(3 * static_cast<std::size_t>(kept));
}

void LocalLoop::refine(const LocalFaces& control, std::span<const LocalValues> values) {
  asked_ = control.asked;
  control_.faces = control.faces;
  control_.sharp = control.sharp;
  control_.values.assign(values.begin(), values.end());
  find_twins(control_.faces, control_.twins, ends_);
  control_.outgoing.assign(control_.values.size(), -1);
  for (std::size_t h = 0; h < control_.twins.size(); ++h)
    control_.outgoing[control_.faces[h / 3][h % 3]] = static_cast<Index>(h);
  refine_level(control_, middle_);
  keep_near(middle_, 4 * static_cast<std::size_t>(asked_));
  refine_level(middle_, fine_);
  find_limits();
}

}  // namespace batten
