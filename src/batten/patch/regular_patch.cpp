#include "batten/patch/regular_patch.h"

#include "batten/parallel/parallel.h"
#include "batten/refine/vertex_blend.h"

namespace batten {

namespace {

/// Of a triangle's patch: each corner's place, then its six neighbours counter-clockwise from the face's own side on.
constexpr int kCornerRings[3][7] = {{0, 1, 2, 8, 6, 3, 4}, {1, 2, 0, 4, 5, 7, 9}, {2, 0, 1, 9, 11, 10, 8}};

bool is_plain(float sharpness) { return !is_sharp(sharpness) || is_infinite(sharpness); }

}  // namespace

PatchFinder::PatchFinder(const Topology& topology, const Scheme& scheme)
    : topology_(topology),
      scheme_(scheme),
      quads_(scheme.kind == SchemeKind::CatmullClark),
      kinds_(static_cast<std::size_t>(topology.vertex_count())) {
  parallel_for(topology.vertex_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) kinds_[v] = classify(v);
  });
}

bool PatchFinder::is_sharp_edge(Index half_edge) const {
  if (topology_.twin(half_edge) < 0) return true;
  return topology_.has_creases() && is_infinite(topology_.edge_sharpness(topology_.edge(half_edge)));
}

bool PatchFinder::has_regular_fan(Index vertex) const {
  const Index start = topology_.vertex_half_edge(vertex);
  Index h = start;
  for (int faces = quads_ ? 4 : 6; faces > 1; --faces) {
    h = topology_.twin(previous(h));
    if (h < 0 || h == start) return false;
  }
  return topology_.twin(previous(h)) == start;
}

PatchFinder::Kind PatchFinder::classify(Index vertex) const {
  if (topology_.is_isolated(vertex)) return Kind::Irregular;
  if (is_untagged(topology_) && !topology_.is_boundary_vertex(vertex))
    return has_regular_fan(vertex) ? Kind::Smooth : Kind::Irregular;
  const float tag = vertex_sharpness(topology_, scheme_, vertex);
  if (!is_plain(tag)) return Kind::Irregular;
  int faces = 0;
  int sharp_edges = topology_.is_boundary_vertex(vertex) ? 1 : 0;  // the last edge, which no half-edge leaves along
  bool plain = true;
  const Index start = topology_.vertex_half_edge(vertex);
  Index h = start;
  do {
    ++faces;
    // Fewer looks at the tables than edge_sharpness() takes, which has to find out whether there is a twin.
    const float sharpness = topology_.twin(h) < 0     ? kInfiniteSharpness
                            : topology_.has_creases() ? topology_.tables().edge_sharpness[topology_.edge(h)]
                                                      : 0.0F;
    plain = plain && is_plain(sharpness);
    sharp_edges += is_infinite(sharpness) ? 1 : 0;
    h = topology_.twin(previous(h));
  } while (h >= 0 && h != start);
  if (!plain) return Kind::Irregular;
  if (is_infinite(tag) || sharp_edges > 2) return Kind::Corner;
  if (sharp_edges == 2) return Kind::Curve;
  return sharp_edges == 0 && faces == (quads_ ? 4 : 6) ? Kind::Smooth : Kind::Irregular;
}

bool PatchFinder::sector_is_regular(Index half_edge) const {
  const Kind kind = kinds_[topology_.origin(half_edge)];
  if (kind == Kind::Smooth) return true;
  if (kind == Kind::Irregular) return false;
  if (kind == Kind::Corner && !quads_) return false;
  const int wanted = kind == Kind::Corner ? 1 : quads_ ? 2 : 3;
  int faces = 1;
  for (Index h = half_edge; faces <= wanted && !is_sharp_edge(h); ++faces) h = next(topology_.twin(h));
  for (Index p = previous(half_edge); faces <= wanted && !is_sharp_edge(p); ++faces) {
    p = previous(topology_.twin(p));
  }
  return faces == wanted;
}

bool PatchFinder::find(Index half_edge, RegularPatch& patch) const {
  const Index face = topology_.face(half_edge);
  for (Index h = topology_.face_begin(face); h < topology_.face_end(face); ++h) {
    if (!sector_is_regular(h)) return false;
  }
  patch.rows.fill(RegularPatch::kMissing);
  if (scheme_.kind == SchemeKind::Loop) {
    find_triangle(half_edge, patch);
  } else {
    find_quad(half_edge, patch);
  }
  return true;
}

void PatchFinder::find_quad(Index half_edge, RegularPatch& patch) const {
  // For each side: the places of its two corners, of the two points across it, and of the point diagonally across its
  // first corner.
  static constexpr int kCorner[4] = {5, 6, 10, 9};
  static constexpr int kAcross[4][2] = {{1, 2}, {7, 11}, {14, 13}, {8, 4}};
  static constexpr int kDiagonal[4] = {0, 3, 15, 12};
  Index h = half_edge;
  for (int side = 0; side < 4; ++side, h = next(h)) {
    patch.rows[kCorner[side]] = topology_.origin(h);
    if (is_sharp_edge(h)) continue;
    const Index across = next(topology_.twin(h));  // leaves the corner, away from the face
    patch.rows[kAcross[side][0]] = topology_.origin(next(across));
    patch.rows[kAcross[side][1]] = topology_.origin(previous(topology_.twin(h)));
    if (!is_sharp_edge(across)) {
      patch.rows[kDiagonal[side]] = topology_.origin(previous(topology_.twin(across)));
    }
  }
}

void PatchFinder::find_triangle(Index half_edge, RegularPatch& patch) const {
  Index side = half_edge;
  for (const auto& ring : kCornerRings) {
    patch.rows[ring[0]] = topology_.origin(side);
    Index h = side;
    int k = 0;
    for (; k < 6; ++k) {  // counter-clockwise to a sharp edge, or once around
      patch.rows[ring[1 + k]] = topology_.origin(next(h));
      const Index p = previous(h);
      if (is_sharp_edge(p)) {
        if (k < 5) patch.rows[ring[2 + k]] = topology_.origin(p);
        break;
      }
      h = topology_.twin(p);
    }
    h = side;
    for (int back = 5; back > k + 1 && k < 6 && !is_sharp_edge(h); --back) {  // then clockwise
      h = next(topology_.twin(h));
      patch.rows[ring[1 + back]] = topology_.origin(next(h));
    }
    side = next(side);
  }
}

namespace {

template <typename Scalar>
void complete_quad_patch(const Index* rows, Scalar* points, int columns) {
  const auto reflect = [&](int to, int across, int from) {
    for (int c = 0; c < columns; ++c) {
      points[to * columns + c] = 2 * points[across * columns + c] - points[from * columns + c];
    }
  };
  const auto missing = [rows](int i) { return rows[i] == RegularPatch::kMissing; };
  // A side that is missing is missing beside both of the face's corners there.
  const bool left = missing(4);
  const bool right = missing(7);
  for (int j = 0; j < 4; ++j) {
    if (missing(4 * j + 1)) continue;
    if (left) reflect(4 * j, 4 * j + 1, 4 * j + 2);
    if (right) reflect(4 * j + 3, 4 * j + 2, 4 * j + 1);
  }
  for (int i = 0; i < 4; ++i) {
    if (missing(1)) reflect(i, 4 + i, 8 + i);
    if (missing(13)) reflect(12 + i, 8 + i, 4 + i);
  }
}

/// Two of a corner v's neighbours p_0 .. p_5 are missing; the curve runs along those beside them. Next to p_a on the
/// curve comes v + p_a - p_b, with p_b on its other side.
template <typename Scalar>
void complete_triangle_patch(const Index* rows, Scalar* points, int columns) {
  for (const auto& ring : kCornerRings) {
    const auto place = [&](int k) { return ring[1 + (k + 6) % 6]; };
    const auto missing = [&](int k) { return rows[place(k)] == RegularPatch::kMissing; };
    for (int k = 0; k < 6; ++k) {
      if (!missing(k)) continue;
      const int step = missing(k - 1) ? 1 : -1;
      const Scalar* v = points + ring[0] * columns;
      const Scalar* curve = points + place(k + step) * columns;
      const Scalar* beyond = points + place(k + 2 * step) * columns;
      Scalar* to = points + place(k) * columns;
      for (int c = 0; c < columns; ++c) to[c] = v[c] + curve[c] - beyond[c];
    }
  }
}

}  // namespace

template <typename Scalar>
void complete_patch(bool quads, const Index* rows, Scalar* points, int columns) {
  if (quads) return complete_quad_patch(rows, points, columns);
  complete_triangle_patch(rows, points, columns);
}

template void complete_patch(bool, const Index*, float*, int);
template void complete_patch(bool, const Index*, double*, int);

}  // namespace batten
