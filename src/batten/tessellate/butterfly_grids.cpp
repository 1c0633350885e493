#include "batten/tessellate/butterfly_grids.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "batten/parallel/parallel.h"
#include "batten/tessellate/lattice_walk.h"

namespace batten {

namespace {

/// The ten points of a stencil, as rows of numbers.
struct StencilRows {
  std::array<const double*, 2> end;
  std::array<const double*, 2> opposite;
  std::array<const double*, 4> wing;
  std::array<const double*, 2> beyond;
};

/// A function of its own, because the compiler believes __restrict of parameters, and then uses whole vector registers.
[[gnu::noinline]] void slide(const ButterflyMask& mask, const StencilRows& rows, double* __restrict out,
                             std::ptrdiff_t count) {
  const double a = mask.end;
  const double b = mask.opposite;
  const double c = mask.wing;
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    out[i] = a * (rows.end[0][i] + rows.end[1][i]) + b * (rows.opposite[0][i] + rows.opposite[1][i]) +
             c * ((rows.wing[0][i] + rows.wing[1][i]) + (rows.wing[2][i] + rows.wing[3][i]));
  }
  if (mask.beyond == 0.0) return;
  const double d = mask.beyond;
  for (std::ptrdiff_t i = 0; i < count; ++i) out[i] += d * (rows.beyond[0][i] + rows.beyond[1][i]);
}

/// One level from the one before it. Rows of `in` and `out` have k numbers.
template <typename Scalar>
class Step {
 public:
  Step(const Topology& base, const ButterflyMasks& masks, const LatticeTags& tags, int level, std::ptrdiff_t columns,
       const double* in, Scalar* out)
      : base_(base),
        masks_(masks),
        tags_(tags),
        from_(base, false, level),
        to_(base, false, level + 1),
        k_(columns),
        in_(in),
        out_(out),
        walk_(base, from_, tags_),
        rules_(walk_, masks_) {}

  void fill(const Progress& progress) const {
    parallel_for(
        base_.vertex_count(),
        [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          Ring ring;
          for (auto v = static_cast<Index>(begin); v < end; ++v) fill_vertex(v, ring);
        },
        kDefaultBlock, progress_within(progress, 0.0, 0.1));
    const auto block = std::max<std::ptrdiff_t>(1, kPointsPerBlock / from_.faces_per_face);
    parallel_for(
        base_.edge_count(),
        [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          EdgeRows rows(from_.steps, k_);
          for (auto e = static_cast<Index>(begin); e < end; ++e) fill_edge(e, rows);
        },
        block, progress_within(progress, 0.1, 0.3));
    parallel_for(
        base_.face_count(),
        [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
          Lattice lattice(from_.steps, k_);
          for (auto f = static_cast<Index>(begin); f < end; ++f) fill_face(f, lattice);
        },
        block, progress_within(progress, 0.3, 1.0));
  }

 private:
  static constexpr std::ptrdiff_t kPointsPerBlock = 16384;
  using HalfEdge = LatticeWalk::HalfEdge;

  /// What surrounds a smooth vertex of the base, as rows of this level: the first points along its edges, twice around;
  /// those after them; and the points between two edges.
  struct Ring {
    Buffer<Index> half_edges;
    Buffer<const double*> edges;
    Buffer<const double*> beyond;
    Buffer<const double*> across;
    void clear() {
      half_edges.clear();
      edges.clear();
      beyond.clear();
      across.clear();
    }
  };

  /// An edge's points and those across, on its left and right, in its direction.
  struct EdgeRows {
    Buffer<double> points;
    Buffer<double> left;
    Buffer<double> right;
    Buffer<double> odd;
    EdgeRows(Index steps, std::ptrdiff_t k)
        : points(static_cast<std::size_t>((steps + 1) * k)),
          left(static_cast<std::size_t>(steps * k)),
          right(left.size()),
          odd(left.size()) {}
  };

  /// A face's points and one more row across each side.
  class Lattice {
   public:
    Lattice(Index steps, std::ptrdiff_t k)
        : k_(k),
          width_((steps + 3) * k),
          points_(static_cast<std::size_t>(width_ * (steps + 3)), 0.0),
          first_(static_cast<std::size_t>(width_)),
          second_(static_cast<std::size_t>(width_)) {}
    double* at(Index i, Index j) { return points_.data() + (j + 1) * width_ + (i + 1) * k_; }
    double* first() { return first_.data(); }
    double* second() { return second_.data(); }

   private:
    std::ptrdiff_t k_;
    std::ptrdiff_t width_;
    Buffer<double> points_;
    Buffer<double> first_;
    Buffer<double> second_;
  };

  const double* row(Index vertex) const { return in_ + vertex * k_; }
  /// Of three numbers without a call, the usual case.
  void copy_row(Index vertex, double* to) const {
    const double* from = row(vertex);
    if (k_ != 3) {
      std::copy_n(from, k_, to);
      return;
    }
    for (int c = 0; c < 3; ++c) to[c] = from[c];
  }
  Index point(Index face, Index i, Index j) const { return from_.vertex(base_, face, i, j); }
  void store(Index vertex, const double* values) const {
    for (std::ptrdiff_t c = 0; c < k_; ++c) out_[vertex * k_ + c] = static_cast<Scalar>(values[c]);
  }

  /// So many steps of the new level along a base half-edge.
  Index new_point(Index half_edge, Index from_origin) const {
    const Index edge = base_.edge(half_edge);
    const bool lower = base_.edge_half_edge(edge) == half_edge;
    return static_cast<Index>(to_.edge_start + to_.per_edge * edge + (lower ? from_origin : to_.steps - from_origin) -
                              1);
  }
  /// Likewise of this level.
  Index old_point(Index half_edge, Index from_origin) const {
    if (from_origin == 0) return base_.origin(half_edge);
    if (from_origin == from_.steps) return base_.destination(half_edge);
    const Index edge = base_.edge(half_edge);
    const bool lower = base_.edge_half_edge(edge) == half_edge;
    return static_cast<Index>(from_.edge_start + from_.per_edge * edge +
                              (lower ? from_origin : from_.steps - from_origin) - 1);
  }

  /// By the rules as they are, wherever a half-edge of the lattice lies.
  void store_by_rules(const HalfEdge& h, Index vertex) const {
    constexpr std::ptrdiff_t kColumns = 3;
    for (std::ptrdiff_t c = 0; c < k_; c += kColumns) {
      const std::ptrdiff_t width = std::min(kColumns, k_ - c);
      double sum[kColumns] = {};
      rules_.visit(h, [&](const LatticeWalk::Vertex& source, double weight) {
        const double* from = in_ + source.number * k_ + c;
        for (std::ptrdiff_t i = 0; i < width; ++i) sum[i] += weight * from[i];
      });
      for (std::ptrdiff_t i = 0; i < width; ++i) out_[vertex * k_ + c + i] = static_cast<Scalar>(sum[i]);
    }
  }
  void store_by_rules(const HalfEdge& upright) const {
    const Index i = 2 * upright.i + (upright.side == 2 ? 0 : 1);
    const Index j = 2 * upright.j + (upright.side == 0 ? 0 : 1);
    store_by_rules(upright, to_.vertex(base_, upright.face, i, j));
  }

  void fill_vertex(Index v, Ring& ring) const {
    store(v, row(v));
    if (base_.is_isolated(v)) return;
    const ButterflyVertex kind = tags_.kinds[v];
    if (kind == ButterflyVertex::Regular || kind == ButterflyVertex::Extraordinary) return fill_spokes(v, ring);
    Index last = -1;
    base_.for_each_outgoing(v, [&](Index h) {
      store_by_rules(walk_.on_base(h, 0), new_point(h, 1));
      last = h;
    });
    if (!base_.is_boundary_vertex(v)) return;
    const Index incoming = base_.previous(last);
    store_by_rules(walk_.on_base(incoming, from_.steps - 1), new_point(incoming, to_.steps - 1));
  }

  /// The first new points along the edges of a smooth vertex.
  void fill_spokes(Index v, Ring& ring) const {
    gather(v, ring);
    const auto n = static_cast<std::ptrdiff_t>(ring.half_edges.size());
    const bool by_ring = masks_.is_modified() && tags_.kinds[v] == ButterflyVertex::Extraordinary;
    RingMask scratch;
    const RingMask* mask = by_ring ? &masks_.extraordinary(static_cast<int>(n), scratch) : nullptr;
    for (std::ptrdiff_t j = 0; j < n; ++j) {
      Scalar* to = out_ + new_point(ring.half_edges[j], 1) * k_;
      for (std::ptrdiff_t c = 0; c < k_; ++c) {
        to[c] =
            static_cast<Scalar>(by_ring ? ring_point(row(v), &ring.edges[j], *mask, c) : stencil_point(v, ring, j, c));
      }
    }
  }

  void gather(Index v, Ring& ring) const {
    ring.clear();
    const Index n = from_.steps;
    base_.for_each_outgoing(v, [&](Index h) {
      const Index face = base_.face(h);
      const Index corner = h - base_.face_begin(face);
      const Index across =
          corner == 0 ? point(face, 1, 1) : (corner == 1 ? point(face, n - 2, 1) : point(face, 1, n - 2));
      ring.half_edges.push_back(h);
      ring.edges.push_back(row(old_point(h, 1)));
      ring.beyond.push_back(row(old_point(h, 2)));
      ring.across.push_back(row(across));
    });
    const std::size_t count = ring.edges.size();
    for (std::size_t j = 0; j < count; ++j) ring.edges.push_back(ring.edges[j]);
  }

  /// edges: from the edge in question on.
  static double ring_point(const double* vertex, const double* const* edges, const RingMask& mask, std::ptrdiff_t c) {
    double sum = mask.vertex * vertex[c];
    for (std::size_t i = 0; i < mask.edges.size(); ++i) sum += mask.edges[i] * edges[i][c];
    return sum;
  }

  double stencil_point(Index v, const Ring& ring, std::ptrdiff_t j, std::ptrdiff_t c) const {
    const auto n = static_cast<std::ptrdiff_t>(ring.half_edges.size());
    const ButterflyMask& mask = masks_.stencil();
    const auto edge = [&](std::ptrdiff_t i) { return ring.edges[(j + i) % n][c]; };
    const double here = row(v)[c];
    const double before = ring.edges[j + n - 1][c];
    double sum = mask.end * (here + edge(0)) + mask.opposite * (before + edge(1)) +
                 mask.wing * (edge(2 * n - 2) + edge(2) + ring.across[j][c] + ring.across[(j + n - 1) % n][c]);
    if (mask.beyond == 0.0) return sum;
    const double behind = tags_.kinds[v] == ButterflyVertex::Regular ? edge(3) : 2.0 * here - edge(0);
    return sum + mask.beyond * (behind + ring.beyond[j][c]);
  }

  /// The points across the segments of a base half-edge, in its face; reversed: from its end on.
  void load_across(Index half_edge, bool reversed, double* to, std::ptrdiff_t stride) const {
    const Index n = from_.steps;
    const Index face = base_.face(half_edge);
    const Index side = half_edge - base_.face_begin(face);
    for (Index s = 0; s < n; ++s) {
      const Index k = reversed ? n - 1 - s : s;
      const Index at =
          side == 0 ? point(face, k, 1) : (side == 1 ? point(face, n - 1 - k, k) : point(face, 1, n - 1 - k));
      copy_row(at, to + s * stride);
    }
  }

  void fill_edge(Index e, EdgeRows& rows) const {
    const Index n = from_.steps;
    const Index h = base_.edge_half_edge(e);
    for (Index s = 0; s <= n; ++s) copy_row(old_point(h, s), rows.points.data() + s * k_);
    for (Index s = 1; s < n; ++s) store(new_point(h, 2 * s), rows.points.data() + s * k_);
    if (n <= 2) return;  // the vertices have made both segments
    const double* p = rows.points.data() + k_;
    const std::ptrdiff_t count = (n - 2) * k_;
    double* odd = rows.odd.data();
    if (tags_.sharp_edges[e] != 0) {
      for (std::ptrdiff_t i = 0; i < count; ++i) {
        odd[i] = kFourPointNear * (p[i] + p[i + k_]) + kFourPointFar * (p[i - k_] + p[i + 2 * k_]);
      }
    } else {
      load_across(h, false, rows.left.data(), k_);
      load_across(base_.twin(h), true, rows.right.data(), k_);
      const double* left = rows.left.data() + k_;
      const double* right = rows.right.data() + k_;
      slide(masks_.stencil(),
            {{p, p + k_}, {left, right}, {left - k_, left + k_, right - k_, right + k_}, {p - k_, p + 2 * k_}}, odd,
            count);
    }
    for (Index s = 1; s + 1 < n; ++s) store(new_point(h, 2 * s + 1), odd + (s - 1) * k_);
  }

  void load(Index face, Lattice& lattice) const {
    const Index n = from_.steps;
    for (Index j = 0; j <= n; ++j) {
      const Index last = n - j;
      const bool inner = j > 0 && last > 1;
      copy_row(point(face, 0, j), lattice.at(0, j));
      if (last == 0) continue;
      copy_row(point(face, last, j), lattice.at(last, j));
      if (inner) {
        std::copy_n(in_ + from_.inside_face(face, j) * k_, (last - 1) * k_, lattice.at(1, j));
      } else {
        for (Index i = 1; i < last; ++i) copy_row(point(face, i, j), lattice.at(i, j));
      }
    }
    const Index first = base_.face_begin(face);
    const std::ptrdiff_t up = lattice.at(0, 1) - lattice.at(0, 0);
    const std::array<double*, 3> from{lattice.at(1, -1), lattice.at(n, 1), lattice.at(-1, n)};
    const std::array<std::ptrdiff_t, 3> stride{k_, up - k_, -up};
    for (Index s = 0; s < 3; ++s) {
      const Index twin = base_.twin(first + s);
      // What lies beyond a boundary no stencil uses that is kept; zeros, because infinities are slow.
      if (twin >= 0) load_across(twin, true, from[s], stride[s]);
    }
  }

  void fill_face(Index face, Lattice& lattice) const {
    const Index n = from_.steps;
    load(face, lattice);
    const ButterflyMask& mask = masks_.stencil();
    const auto at = [&](Index i, Index j) -> const double* { return lattice.at(i, j); };
    for (Index j = 1; j < n; ++j) {  // along the rows
      slide(mask,
            {{at(0, j), at(1, j)},
             {at(0, j + 1), at(1, j - 1)},
             {at(-1, j + 1), at(1, j + 1), at(0, j - 1), at(2, j - 1)},
             {at(-1, j), at(2, j)}},
            lattice.first(), (n - j) * k_);
      Scalar* to = out_ + to_.inside_face(face, 2 * j) * k_;
      interleave(lattice.first(), at(1, j), n - j, n - j - 1, to);
    }
    for (Index j = 0; j + 1 < n; ++j) {  // between the rows: (i+1, j) to (i, j+1), and (i, j) to (i, j+1)
      slide(mask,
            {{at(1, j), at(0, j + 1)},
             {at(0, j), at(1, j + 1)},
             {at(1, j - 1), at(-1, j + 1), at(2, j), at(0, j + 2)},
             {at(2, j - 1), at(-1, j + 2)}},
            lattice.first(), (n - 1 - j) * k_);
      slide(mask,
            {{at(1, j), at(1, j + 1)},
             {at(2, j), at(0, j + 1)},
             {at(2, j - 1), at(2, j + 1), at(0, j), at(0, j + 2)},
             {at(1, j - 1), at(1, j + 2)}},
            lattice.second(), (n - 1 - j) * k_);
      Scalar* to = out_ + to_.inside_face(face, 2 * j + 1) * k_;
      interleave(lattice.first(), lattice.second(), n - 1 - j, n - 1 - j, to);
    }
    const Index first = base_.face_begin(face);
    for (int s = 0; s < 3; ++s) {
      if (tags_.sharp_edges[base_.edge(first + s)] != 0) fill_beside_sharp(face, s);
    }
  }

  /// a_0 b_0 a_1 b_1 ...
  void interleave(const double* a, const double* b, std::ptrdiff_t a_count, std::ptrdiff_t b_count, Scalar* to) const {
    if (k_ == 3) {
      for (std::ptrdiff_t i = 0; i < b_count; ++i) {
        for (int c = 0; c < 3; ++c) to[6 * i + c] = static_cast<Scalar>(a[3 * i + c]);
        for (int c = 0; c < 3; ++c) to[6 * i + 3 + c] = static_cast<Scalar>(b[3 * i + c]);
      }
    } else {
      for (std::ptrdiff_t i = 0; i < b_count; ++i) {
        for (std::ptrdiff_t c = 0; c < k_; ++c) to[2 * k_ * i + c] = static_cast<Scalar>(a[k_ * i + c]);
        for (std::ptrdiff_t c = 0; c < k_; ++c) to[2 * k_ * i + k_ + c] = static_cast<Scalar>(b[k_ * i + c]);
      }
    }
    if (a_count == b_count) return;
    for (std::ptrdiff_t c = 0; c < k_; ++c) to[2 * k_ * b_count + c] = static_cast<Scalar>(a[k_ * b_count + c]);
  }

  /// The edges that run from the points inside a sharp side into the face.
  void fill_beside_sharp(Index face, int side) const {
    for (Index s = 1; s < from_.steps; ++s) {
      const Index back = from_.steps - s;
      if (side == 0) {
        store_by_rules({face, s, 0, false, 2});
        store_by_rules({face, s - 1, 0, false, 1});
      } else if (side == 1) {
        store_by_rules({face, back - 1, s, false, 0});
        store_by_rules({face, back, s - 1, false, 2});
      } else {
        store_by_rules({face, 0, s, false, 0});
        store_by_rules({face, 0, s - 1, false, 1});
      }
    }
  }

  const Topology& base_;
  const ButterflyMasks& masks_;
  const LatticeTags& tags_;
  TessellationLayout from_;
  TessellationLayout to_;
  std::ptrdiff_t k_;
  const double* in_;
  Scalar* out_;
  LatticeWalk walk_;
  ButterflyRules<LatticeWalk> rules_;
};

}  // namespace

template <typename Scalar>
void fill_butterfly_grids(const Topology& base, const Scheme& scheme, ConstValuesRef control, int levels, Scalar* out,
                          const Progress& progress) {
  if (control.size() == 0) return;
  // Each level takes four times as long as the one before. The first has the order of refine_values: V, then edges.
  const auto part = [&](int level) {
    const double end = std::pow(0.25, levels - level);
    return progress_within(progress, level == 1 ? 0.0 : 0.25 * end, end);
  };
  if (levels == 1) return refine_butterfly_values(base, scheme, control, out, part(1));
  const std::ptrdiff_t k = control.cols();
  const auto room = [&](int level) {
    return static_cast<std::size_t>(TessellationLayout(base, false, level).vertices * k);
  };
  Buffer<double> values(room(1));
  refine_butterfly_values(base, scheme, control, values.data(), part(1));
  const ButterflyMasks masks(scheme);
  LatticeTags tags = lattice_tags(base, scheme, 1);
  const bool changing = tags_fade(base);
  for (int level = 1; level < levels; ++level) {
    if (changing && level > 1) tags = lattice_tags(base, scheme, level);
    if (level + 1 == levels) {
      return Step<Scalar>(base, masks, tags, level, k, values.data(), out).fill(part(level + 1));
    }
    Buffer<double> next(room(level + 1));
    Step<double>(base, masks, tags, level, k, values.data(), next.data()).fill(part(level + 1));
    values = std::move(next);
  }
}

template void fill_butterfly_grids(const Topology&, const Scheme&, ConstValuesRef, int, float*, const Progress&);
template void fill_butterfly_grids(const Topology&, const Scheme&, ConstValuesRef, int, double*, const Progress&);

}  // namespace batten
