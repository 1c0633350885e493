#include "batten/tessellate/side_normals.h"

#include <unordered_map>
#include <utility>
#include <vector>

#include "batten/limit/limit_matrix.h"

namespace batten {

namespace {

/// The normals of two faces on the same side differ by rounding only.
constexpr double kSameNormal = 1e-9;

/// The points of a base face's grid, counted along one of its sides and away from it.
class SideGrid {
 public:
  SideGrid(const Tessellator& tessellator, Index half_edge)
      : tessellator_(tessellator),
        quads_(tessellator.face_size() == 4),
        steps_(tessellator.steps()),
        face_(tessellator.base().face(half_edge)),
        side_(half_edge - tessellator.base().face_begin(face_)) {}

  Index row_length(Index depth) const { return quads_ ? steps_ + 1 : steps_ + 1 - depth; }
  Index vertex(Index along, Index depth) const {
    const Index n = steps_;
    const Index far = n - along;
    if (quads_) {
      if (side_ == 0) return tessellator_.vertex(face_, along, depth);
      if (side_ == 1) return tessellator_.vertex(face_, n - depth, along);
      if (side_ == 2) return tessellator_.vertex(face_, far, n - depth);
      return tessellator_.vertex(face_, depth, far);
    }
    // Barycentric: n - along - depth at the side's first corner, along at its second, depth at the third.
    if (side_ == 0) return tessellator_.vertex(face_, along, depth);
    if (side_ == 1) return tessellator_.vertex(face_, far - depth, along);
    return tessellator_.vertex(face_, depth, far - depth);
  }

 private:
  const Tessellator& tessellator_;
  bool quads_;
  Index steps_;
  Index face_;
  Index side_;
};

/// Half-edges on the side of an infinitely sharp edge whose normals its vertices do not have: the vertices inside an
/// edge have those of its lower half-edge's side.
Buffer<Index> other_sides(const Topology& base) {
  Buffer<Index> sides;
  if (!base.has_creases()) return sides;
  for (Index e = 0; e < base.edge_count(); ++e) {
    if (base.is_boundary_edge(e) || base.edge_sharpness(e) < kInfiniteSharpness) continue;
    sides.push_back(base.twin(base.edge_half_edge(e)));
  }
  return sides;
}

/// The first row of faces along each side, as a mesh of refined control points: a crease looks to each of its sides as
/// a boundary does.
Mesh strips_along(const Tessellator& tessellator, const Buffer<Index>& sides, ConstValuesRef refined) {
  Mesh mesh;
  std::vector<Index> sources;
  for (const Index side : sides) {
    const SideGrid grid(tessellator, side);
    const auto first = static_cast<Index>(sources.size());
    for (Index depth = 0; depth < 2; ++depth) {
      for (Index i = 0; i < grid.row_length(depth); ++i) sources.push_back(grid.vertex(i, depth));
    }
    const Index second = first + grid.row_length(0);
    for (Index i = 0; i < tessellator.steps(); ++i) {
      if (tessellator.face_size() == 4) {
        mesh.add_face({first + i, first + i + 1, second + i + 1, second + i});
        continue;
      }
      mesh.add_face({first + i, first + i + 1, second + i});
      if (i + 1 < grid.row_length(1)) mesh.add_face({first + i + 1, second + i + 1, second + i});
    }
  }
  mesh.points = refined(sources, Eigen::all);
  return mesh;
}

/// Normals at the vertices inside each side: steps - 1 rows a side.
Values normals_inside(const TessellatedNormals& surface, const Buffer<Index>& sides) {
  const Index steps = surface.tessellator.steps();
  Values inside(static_cast<Eigen::Index>(sides.size()) * (steps - 1), 3);
  if (inside.rows() == 0) return inside;
  Values refined(surface.vertices.rows(), 3);
  surface.tessellator.refined<double>(surface.control, {refined.data(), static_cast<std::size_t>(refined.size())});
  const Mesh strips = strips_along(surface.tessellator, sides, refined);
  Scheme scheme = surface.patches.base_scheme();
  scheme.boundary = BoundaryRule::EdgeOnly;
  const Values normals = limit_normals(Topology(strips), scheme, strips.points).vertices;
  const Eigen::Index per_strip = strips.points.rows() / static_cast<Eigen::Index>(sides.size());
  for (Eigen::Index s = 0; s < static_cast<Eigen::Index>(sides.size()); ++s) {
    inside.middleRows(s * (steps - 1), steps - 1) = normals.middleRows(s * per_strip + 1, steps - 1);
  }
  return inside;
}

/// The rows beyond the vertices', and which corners have them.
class SideRows {
 public:
  explicit SideRows(const TessellatedNormals& surface) : surface_(surface) {}

  /// The normal at a vertex for the corners of this base face, where it differs from the vertex's own.
  void add(Index base_face, Index vertex, const Eigen::RowVector3d& normal) {
    if ((normal - surface_.vertices.row(vertex)).norm() <= kSameNormal) return;
    faces_[base_face].emplace_back(vertex, static_cast<Index>(surface_.vertices.rows() + extra_.size()));
    extra_.push_back(normal);
  }

  Attribute attribute() const {
    if (extra_.empty()) return {"normal", Values(), {}};
    Attribute result{"normal", Values(surface_.vertices.rows() + static_cast<Eigen::Index>(extra_.size()), 3),
                     surface_.face_vertices};
    result.values.topRows(surface_.vertices.rows()) = surface_.vertices;
    for (std::size_t i = 0; i < extra_.size(); ++i) {
      result.values.row(surface_.vertices.rows() + static_cast<Eigen::Index>(i)) = extra_[i];
    }
    const Tessellator& tessellator = surface_.tessellator;
    const auto per_face = static_cast<std::size_t>(tessellator.steps()) *
                          static_cast<std::size_t>(tessellator.steps()) *
                          static_cast<std::size_t>(tessellator.face_size());
    for (const auto& entry : faces_) {
      const std::unordered_map<Index, Index> row_of(entry.second.begin(), entry.second.end());
      const std::size_t first = static_cast<std::size_t>(surface_.face_rank[entry.first]) * per_face;
      for (std::size_t c = first; c < first + per_face; ++c) {
        const auto found = row_of.find(result.corner_rows[c]);
        if (found != row_of.end()) result.corner_rows[c] = found->second;
      }
    }
    return result;
  }

 private:
  const TessellatedNormals& surface_;
  std::vector<Eigen::RowVector3d> extra_;
  std::unordered_map<Index, std::vector<std::pair<Index, Index>>> faces_;  // a base face's vertices and their rows
};

}  // namespace

Attribute side_normals(const TessellatedNormals& surface) {
  const Tessellator& tessellator = surface.tessellator;
  const Topology& base = tessellator.base();
  const Buffer<Index> sides = other_sides(base);
  SideRows rows(surface);
  if (sides.empty()) return rows.attribute();
  const Values control = surface.patches.base_values(surface.control);
  const Values at_corners = limit_normals(base, surface.patches.base_scheme(), control).corners;
  Buffer<std::uint8_t> on_crease(static_cast<std::size_t>(base.vertex_count()), 0);
  for (const Index h : sides) on_crease[base.origin(h)] = on_crease[base.destination(h)] = 1;
  for (Index h = 0; h < base.half_edge_count(); ++h) {
    const bool drawn = surface.face_rank[base.face(h)] >= 0;
    if (drawn && on_crease[base.origin(h)] != 0) rows.add(base.face(h), base.origin(h), at_corners.row(h));
  }
  const Values inside = normals_inside(surface, sides);
  const Index per_side = tessellator.steps() - 1;
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const Index face = base.face(sides[s]);
    if (surface.face_rank[face] < 0) continue;
    const SideGrid grid(tessellator, sides[s]);
    for (Index i = 0; i < per_side; ++i) {
      rows.add(face, grid.vertex(i + 1, 0), inside.row(static_cast<Eigen::Index>(s) * per_side + i));
    }
  }
  return rows.attribute();
}

}  // namespace batten
