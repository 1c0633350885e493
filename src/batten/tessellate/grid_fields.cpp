#include "batten/tessellate/grid_fields.h"

#include <algorithm>
#include <array>
#include <cmath>

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

}  // namespace batten
