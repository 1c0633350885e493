#include "batten/medial/spoke_mesh.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <utility>

#include "batten/medial/medial_boundary.h"
#include "batten/medial/medial_refinement.h"

namespace batten {

namespace {

constexpr Index kSides = 5;  ///< of a prism

/// sRGB, apart for people who see fewer colours (key OI08).
Eigen::RowVector3d color_of(SpokeSide side) {
  if (side == SpokeSide::Up) return {0.0, 0.447, 0.698};
  if (side == SpokeSide::Down) return {0.902, 0.624, 0.0};
  return {0.8, 0.2, 0.2};
}

/// Writes the prism's vertices from row `first` on, one ring at each end.
void set_prism(const Eigen::RowVector3d& from, const Eigen::RowVector3d& along, double radius, Index first,
               Points& points) {
  const Eigen::RowVector3d across = along.normalized().unitOrthogonal();
  const Eigen::RowVector3d other = along.normalized().cross(across);
  for (Index i = 0; i < kSides; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / kSides;
    const Eigen::RowVector3d out = radius * (std::cos(turn) * across + std::sin(turn) * other);
    points.row(first + i) = from + out;
    points.row(first + kSides + i) = from + along + out;
  }
}

void add_prism_faces(Index first, Mesh& mesh) {
  for (Index i = 0; i < kSides; ++i) {
    const Index next = (i + 1) % kSides;
    mesh.add_face({first + i, first + next, first + kSides + next, first + kSides + i});
  }
  mesh.add_face({first + 4, first + 3, first + 2, first + 1, first});
  mesh.add_face({first + kSides, first + kSides + 1, first + kSides + 2, first + kSides + 3, first + kSides + 4});
}

}  // namespace

Mesh spoke_mesh(const MedialModel& model, double thickness) {
  const MedialBoundary boundary = medial_boundary(model);
  Mesh mesh = sheet_mesh(model);
  mesh.attributes.clear();
  mesh.groups.clear();
  const Index sheets = mesh.vertex_count();
  const Index spokes = boundary.mesh.vertex_count();
  const Eigen::Index rows = static_cast<Eigen::Index>(sheets) + static_cast<Eigen::Index>(2 * kSides) * spokes;
  mesh.points.conservativeResize(rows, 3);
  Attribute color{"color", Values(rows, 3), {}};
  color.values.topRows(sheets).setConstant(0.75);
  const double radius = 0.5 * thickness * bounding_diagonal(boundary.mesh.points);
  for (Index spoke = 0; spoke < spokes; ++spoke) {
    const Index first = sheets + 2 * kSides * spoke;
    const Eigen::RowVector3d along = boundary.radii(spoke) * boundary.directions.row(spoke);
    set_prism(boundary.origins.row(spoke), along, radius, first, mesh.points);
    add_prism_faces(first, mesh);
    color.values.middleRows(first, 2 * kSides).rowwise() =
        color_of(boundary.ends[static_cast<std::size_t>(spoke)].side);
  }
  mesh.attributes.push_back(std::move(color));
  return mesh;
}

}  // namespace batten
