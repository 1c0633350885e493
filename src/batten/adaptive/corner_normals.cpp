#include "batten/adaptive/corner_normals.h"

#include <Eigen/Geometry>
#include <utility>

namespace batten {

namespace {

/// Equal normals of two sides differ by rounding only.
constexpr double kSameNormal = 1e-9;

/// The creases of the base, by the places on their sides and at their ends.
class Creases {
 public:
  explicit Creases(const Topology& base) : base_(base), at_vertex_(static_cast<std::size_t>(base.vertex_count()), 0) {
    for (Index e = 0; base.has_creases() && e < base.edge_count(); ++e) {
      if (base.is_boundary_edge(e) || !(base.edge_sharpness(e) > 0.0F)) continue;
      const Index h = base.edge_half_edge(e);
      at_vertex_[base.origin(h)] = at_vertex_[base.destination(h)] = 1;
      any_ = true;
    }
  }
  bool any() const { return any_; }

  bool meet(Index face, const std::array<double, 2>& at) const {
    const Index first = base_.face_begin(face);
    const auto [u, v] = at;
    const bool quad = base_.face_size(face) == 4;
    const bool on[4] = {v == 0.0, quad ? u == 1.0 : u + v == 1.0, quad ? v == 1.0 : u == 0.0, quad && u == 0.0};
    for (Index s = 0; s < base_.face_size(face); ++s) {
      if (!on[s]) continue;
      const Index h = first + s;
      if (on[s == 0 ? base_.face_size(face) - 1 : s - 1] && at_vertex_[base_.origin(h)] != 0) return true;
      if (base_.twin(h) >= 0 && base_.edge_sharpness(base_.edge(h)) > 0.0F) return true;
    }
    return false;
  }

 private:
  const Topology& base_;
  Buffer<std::uint8_t> at_vertex_;
  bool any_ = false;
};

}  // namespace

Eigen::Vector3d unit_normal(const Jet& jet) {
  const Eigen::Vector3d cross = jet.du.cross(jet.dv);
  const double length = cross.norm();
  return length > 0.0 ? Eigen::Vector3d(cross / length) : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

CornerNormals corner_normals(const NormalsAt& normals_at, const CellFaces& faces, const CellForest& forest,
                             const Points& vertex_normals) {
  const Creases creases(forest.base());
  if (!creases.any()) return {vertex_normals, {}};
  Buffer<std::size_t> corners;
  std::vector<SurfacePlace> places;
  for (std::size_t c = 0; c < faces.vertices.size(); ++c) {
    const Index face = forest.face(faces.cells[c / static_cast<std::size_t>(faces.size)]);
    if (!creases.meet(face, faces.places[c])) continue;
    corners.push_back(c);
    places.push_back({face, faces.places[c][0], faces.places[c][1]});
  }
  const Points normals = normals_at(places);
  Buffer<Index> rows = faces.vertices;
  Buffer<std::size_t> differing;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if ((normals.row(row) - vertex_normals.row(faces.vertices[corners[i]])).norm() <= kSameNormal) continue;
    rows[corners[i]] = static_cast<Index>(vertex_normals.rows() + static_cast<Eigen::Index>(differing.size()));
    differing.push_back(i);
  }
  if (differing.empty()) return {vertex_normals, {}};
  Values all(vertex_normals.rows() + static_cast<Eigen::Index>(differing.size()), 3);
  all.topRows(vertex_normals.rows()) = vertex_normals;
  for (std::size_t i = 0; i < differing.size(); ++i) {
    all.row(vertex_normals.rows() + static_cast<Eigen::Index>(i)) =
        normals.row(static_cast<Eigen::Index>(differing[i]));
  }
  return {std::move(all), std::move(rows)};
}

}  // namespace batten
