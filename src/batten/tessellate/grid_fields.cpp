#include "batten/tessellate/grid_fields.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "batten/mesh/vertex_fields.h"
#include "batten/parallel/parallel.h"
#include "batten/tessellate/tessellation_layout.h"

namespace batten {

namespace {

int levels_of(Index steps) {
  int levels = 0;
  while ((Index{1} << levels) < steps) ++levels;
  return levels;
}

TessellationLayout layout_of(const Tessellator& tessellator) {
  return {tessellator.base(), tessellator.face_size() == 4, levels_of(tessellator.steps())};
}

/// Calls visit(i, j, vertex) for the points of a face's grid that belong to the face.
template <typename Visit>
void for_each_owned(const Topology& base, const TessellationLayout& layout, Index face, const Visit& visit) {
  for (Index j = 0; j <= layout.steps; ++j) {
    for (Index i = 0; i < layout.row_length(j); ++i) {
      const GridPoint at = layout.locate(base, face, i, j);
      if (at.half_edge >= 0) {
        const Index owner = at.from_origin == 0 ? base.vertex_half_edge(base.origin(at.half_edge))
                                                : base.edge_half_edge(base.edge(at.half_edge));
        if (owner != at.half_edge) continue;
      }
      visit(i, j, layout.vertex(base, face, i, j));
    }
  }
}

/// A field that is linear between the points of a coarse lattice over each base face: its corners, points along its
/// sides, and zeros inside.
class SideLattice {
 public:
  /// The base is the control mesh: creases fade over a quarter of a face. Or it is the first refinement of it, whose
  /// faces are half as wide.
  SideLattice(const Topology& topology, const Topology& base, bool quads)
      : base_(base),
        refined_(base.half_edge_count() != topology.half_edge_count()),
        lattice_(base, quads, refined_ ? 1 : 2),
        size_(lattice_.steps),
        at_vertices_(Scalars::Zero(base.vertex_count())) {
    at_vertices_.head(topology.vertex_count()) = vertex_sharpnesses(topology);
    for (Index e = 0; refined_ && e < topology.edge_count(); ++e) {
      at_vertices_[topology.vertex_count() + e] = crease_sharpness(topology, e);
    }
  }

  /// u, v in [0, 1].
  double operator()(Index face, double u, double v) const {
    const auto cell = [&](double at) { return std::min(static_cast<Index>(at), size_ - 1); };
    const Index i = cell(u * size_);
    const Index j = cell(v * size_);
    const double s = u * size_ - i;
    const double t = v * size_ - j;
    const auto value = [&](Index a, Index b) { return at(face, a, b); };
    if (lattice_.quads) {
      return (1.0 - t) * ((1.0 - s) * value(i, j) + s * value(i + 1, j)) +
             t * ((1.0 - s) * value(i, j + 1) + s * value(i + 1, j + 1));
    }
    if (s + t <= 1.0) {
      return (1.0 - s - t) * value(i, j) + s * value(i + 1, j) + t * value(i, j + 1);
    }
    return (1.0 - t) * value(i + 1, j) + (1.0 - s) * value(i, j + 1) + (s + t - 1.0) * value(i + 1, j + 1);
  }

 private:
  static double along(double a, double b) { return a > 0.0 && b > 0.0 ? 0.5 * (a + b) : 0.0; }

  double at(Index face, Index i, Index j) const {
    if (!lattice_.quads && i + j > size_) return 0.0;  // outside the triangle, where its weight is zero
    const GridPoint place = lattice_.locate(base_, face, i, j);
    if (place.half_edge < 0) return 0.0;
    const double first = at_vertices_[base_.origin(place.half_edge)];
    if (place.from_origin == 0) return first;
    const double second = at_vertices_[base_.destination(place.half_edge)];
    if (refined_) return along(first, second);
    const double middle = crease_sharpness(base_, base_.edge(place.half_edge));
    if (place.from_origin == 2) return middle;
    return along(place.from_origin == 1 ? first : second, middle);
  }

  const Topology& base_;
  bool refined_;
  TessellationLayout lattice_;
  Index size_;
  Scalars at_vertices_;
};

/// The vertex at (i, j) of a quad's grid of n by n, followed down to the level where it is a corner. Quad h of the next
/// level starts at the origin of half-edge h and runs along it.
Index quad_vertex(std::span<const Topology> levels, Index face, Index n, Index i, Index j) {
  for (std::size_t level = 0; n > 1; ++level, n /= 2) {
    const Index half = n / 2;
    const Index first = levels[level].face_begin(face);
    const Index u = i;
    const Index v = j;
    if (u <= half && v <= half) {
      face = first;
    } else if (v <= half) {
      face = first + 1;
      i = v;
      j = n - u;
    } else if (u > half) {
      face = first + 2;
      i = n - u;
      j = n - v;
    } else {
      face = first + 3;
      i = n - v;
      j = u;
    }
  }
  const Index corner = i == 0 ? (j == 0 ? 0 : 3) : (j == 0 ? 1 : 2);
  return levels.back().origin(levels.back().face_begin(face) + corner);
}

/// The same in a triangle, for the weights of its corners, which are whole numbers with a power of two as their sum.
Index triangle_vertex(std::span<const Topology> levels, Index face, std::array<Index, 3> weights) {
  Index half = (weights[0] + weights[1] + weights[2]) / 2;
  for (std::size_t level = 0; half > 0; ++level, half /= 2) {
    const Topology& topology = levels[level];
    const Topology& next = levels[level + 1];
    const Index h = topology.face_begin(face);
    std::array<std::pair<Index, Index>, 3> parts;  // vertices of the next level, and their weights
    const auto middle = [&](Index k) { return topology.vertex_count() + topology.edge(h + k % 3); };
    Index child = 3;
    for (Index k = 0; k < 3; ++k) {
      parts[static_cast<std::size_t>(k)] = {middle(k), half - weights[static_cast<std::size_t>((k + 2) % 3)]};
      if (weights[static_cast<std::size_t>(k)] >= half) child = k;
    }
    if (child < 3) {
      const auto at = [&](Index k) { return weights[static_cast<std::size_t>((child + k) % 3)]; };
      parts = {{{topology.origin(h + child), at(0) - half}, {middle(child), at(1)}, {middle(child + 2), at(2)}}};
    }
    face = 4 * face + child;
    for (std::size_t k = 0; k < 3; ++k) {
      for (const std::pair<Index, Index>& part : parts) {
        if (next.origin(next.face_begin(face) + static_cast<Index>(k)) == part.first) weights[k] = part.second;
      }
    }
  }
  for (Index k = 0; k < 3; ++k) {
    if (weights[static_cast<std::size_t>(k)] > 0) return levels.back().origin(levels.back().face_begin(face) + k);
  }
  return -1;
}

}  // namespace

Buffer<SurfacePlace> vertex_places(const Tessellator& tessellator) {
  const Topology& base = tessellator.base();
  const TessellationLayout layout = layout_of(tessellator);
  Buffer<SurfacePlace> places(static_cast<std::size_t>(layout.vertices), SurfacePlace{-1, 0.0, 0.0});
  parallel_for(base.face_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      for_each_owned(base, layout, f, [&](Index i, Index j, Index vertex) {
        places[vertex] = {f, static_cast<double>(i) / layout.steps, static_cast<double>(j) / layout.steps};
      });
    }
  });
  return places;
}

Scalars sharpness_field(const Topology& topology, const Tessellator& tessellator) {
  const Topology& base = tessellator.base();
  const TessellationLayout layout = layout_of(tessellator);
  const SideLattice lattice(topology, base, layout.quads);
  Scalars field = Scalars::Zero(layout.vertices);
  field.head(topology.vertex_count()) = vertex_sharpnesses(topology);
  parallel_for(base.face_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      for_each_owned(base, layout, f, [&](Index i, Index j, Index vertex) {
        field[vertex] = lattice(f, static_cast<double>(i) / layout.steps, static_cast<double>(j) / layout.steps);
      });
    }
  });
  return field;
}

std::vector<CreaseCurve> crease_curves(const Topology& topology, const Tessellator& tessellator) {
  const Topology& base = tessellator.base();
  const bool refined = base.half_edge_count() != topology.half_edge_count();
  const Index inside = tessellator.steps() - 1;  // points inside each edge of the base
  std::vector<CreaseCurve> curves;
  for (Index e = 0; e < topology.edge_count(); ++e) {
    const double sharpness = crease_sharpness(topology, e);
    if (sharpness <= 0.0) continue;
    const Index h = topology.edge_half_edge(e);
    std::vector<Index> parts{h};
    // The first refinement makes of half-edge h the quad h, which starts along the first half of h; the second half is
    // the last side of the next quad.
    if (refined) parts = {4 * h, 4 * topology.next(h) + 3};
    CreaseCurve curve{{base.origin(parts.front())}, sharpness};
    for (const Index part : parts) {
      const bool forward = base.edge_half_edge(base.edge(part)) == part;
      const Index first = base.vertex_count() + base.edge(part) * inside;
      for (Index i = 0; i < inside; ++i) curve.vertices.push_back(first + (forward ? i : inside - 1 - i));
      curve.vertices.push_back(base.destination(part));
    }
    curves.push_back(std::move(curve));
  }
  return curves;
}

Buffer<Index> refinement_order(const Tessellator& tessellator, std::span<const Topology> levels) {
  const Topology& base = levels.front();
  const TessellationLayout layout = layout_of(tessellator);
  Buffer<Index> order(static_cast<std::size_t>(layout.vertices));
  for (Index v = 0; v < base.vertex_count(); ++v) order[v] = v;  // also those without a face
  parallel_for(base.face_count(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      for_each_owned(base, layout, f, [&](Index i, Index j, Index vertex) {
        order[vertex] = layout.quads ? quad_vertex(levels, f, layout.steps, i, j)
                                     : triangle_vertex(levels, f, {layout.steps - i - j, i, j});
      });
    }
  });
  return order;
}

}  // namespace batten
