#include "batten/refine/refined_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "batten/error.h"
#include "batten/mesh/primitives.h"
#include "batten/refine/refinement.h"

namespace batten {
namespace {

/// Every face of d corners has a regular d-gon of its own as its texture.
Attribute faces_apart(const Mesh& mesh) {
  Attribute uv{"uv", Values(static_cast<Eigen::Index>(mesh.face_vertices.size()), 2), {}};
  for (Index f = 0; f < mesh.face_count(); ++f) {
    for (Index i = 0; i < mesh.face_size(f); ++i) {
      const double angle = 2.0 * EIGEN_PI * i / mesh.face_size(f);
      uv.values.row(mesh.face_offsets[f] + i) << 3.0 * f + std::cos(angle), std::sin(angle);
      uv.corner_rows.push_back(mesh.face_offsets[f] + i);
    }
  }
  return uv;
}

double area(const Mesh& mesh, const Attribute& uv, Index face) {
  double twice = 0.0;
  const Index first = mesh.face_offsets[face];
  const Index size = mesh.face_size(face);
  for (Index i = 0; i < size; ++i) {
    const Eigen::RowVector2d a = uv.values.row(uv.corner_rows[first + i]);
    const Eigen::RowVector2d b = uv.values.row(uv.corner_rows[first + (i + 1) % size]);
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return 0.5 * twice;
}

void expect_equal_pieces(const Mesh& mesh, SchemeKind kind) {
  Mesh control = mesh;
  control.attributes = {faces_apart(mesh)};
  Scheme scheme;
  scheme.kind = kind;
  const Topology topology(control);
  const RefinedMesh refined = refine_mesh(topology, scheme, control, 3);
  ASSERT_EQ(refined.mesh.attributes.size(), 1U);
  const double expected = area(control, control.attributes[0], 0) * mesh.face_count() / refined.mesh.face_count();
  for (Index f = 0; f < refined.mesh.face_count(); ++f) {
    ASSERT_NEAR(area(refined.mesh, refined.mesh.attributes[0], f), expected, 1e-13) << f;
  }
}

TEST(RefinedMesh, TexturesAreCutIntoEqualPiecesWithTheirFaces) {
  expect_equal_pieces(cube(), SchemeKind::CatmullClark);
  expect_equal_pieces(octahedron(), SchemeKind::Loop);
}

TEST(RefinedMesh, WithoutASeamACornerAttributeHasARowAVertex) {
  Mesh mesh = torus(5, 4);
  mesh.attributes = {{"uv", mesh.points.leftCols(2), mesh.face_vertices}};
  const Topology topology(mesh);
  const Attribute refined = refine_at_corners(topology, SchemeKind::CatmullClark, mesh.attributes[0]);
  EXPECT_EQ(refined.values.rows(), topology.vertex_count() + topology.edge_count() + topology.face_count());
  const Index h = topology.edge_half_edge(7);
  const Eigen::RowVector2d middle =
      0.5 * (mesh.points.row(topology.origin(h)) + mesh.points.row(topology.destination(h))).head(2);
  EXPECT_EQ(refined.values.row(refined.corner_rows[4 * h + 1]), middle);
  EXPECT_EQ(refined.corner_rows[4 * h + 1], refined.corner_rows[4 * topology.next(topology.twin(h)) + 3]);
}

TEST(RefinedMesh, NothingComesOfACornerWithoutARow) {
  Mesh mesh = grid(2, 1);
  Attribute uv = faces_apart(mesh);
  uv.corner_rows[0] = -1;
  const Attribute refined = refine_at_corners(Topology(mesh), SchemeKind::CatmullClark, uv);
  EXPECT_TRUE(refined.values.allFinite());
  // The corner itself, its two edges at both ends, the face's centre in its four quads.
  EXPECT_EQ(std::count(refined.corner_rows.begin(), refined.corner_rows.end(), -1), 1 + 4 + 4);
  uv.corner_rows.pop_back();
  EXPECT_THROW(refine_at_corners(Topology(mesh), SchemeKind::CatmullClark, uv), Error);
}

TEST(RefinedMesh, PointsAndVertexAttributesFollowTheScheme) {
  Mesh mesh = torus(5, 4);
  mesh.attributes = {{"heat", mesh.points.col(0), {}}, {"normal", mesh.points, {}}};
  const Topology topology(mesh);
  const RefinedMesh refined = refine_mesh(topology, {}, mesh, 2);
  EXPECT_EQ(refined.mesh.points, refine(topology, {}, mesh.points, 2).values);
  ASSERT_EQ(refined.mesh.attributes.size(), 1U);
  EXPECT_EQ(refined.mesh.attributes[0].values, refined.mesh.points.col(0));
}

TEST(RefinedMesh, MidpointsKeepTheValuesAndTheirRange) {
  for (const SchemeKind kind : {SchemeKind::CatmullClark, SchemeKind::Loop}) {
    Mesh mesh = kind == SchemeKind::Loop ? octahedron() : dodecahedron();
    const Values heat = Values::Random(mesh.vertex_count(), 2);
    mesh.attributes = {{"heat", heat, {}, CarryRule::Midpoint}};
    Scheme scheme;
    scheme.kind = kind;
    const Topology topology(mesh);
    const Mesh refined = refine_mesh(topology, scheme, mesh, 2).mesh;
    const Values& fine = refined.attributes[0].values;
    EXPECT_EQ(fine.topRows(mesh.vertex_count()), heat);
    EXPECT_LE(fine.maxCoeff(), heat.maxCoeff());
    EXPECT_GE(fine.minCoeff(), heat.minCoeff());
    const Values once = refine_midpoints(topology, kind, heat);
    const Index h = topology.edge_half_edge(3);
    const Eigen::RowVector2d ends = heat.row(topology.origin(h)) + heat.row(topology.destination(h));
    EXPECT_EQ(once.row(mesh.vertex_count() + 3), 0.5 * ends);
    EXPECT_EQ(fine.topRows(once.rows()), once);
  }
}

TEST(RefinedMesh, GroupsFollowTheirFaces) {
  Mesh mesh = grid(3, 1);
  mesh.groups = {{"g", "a", 0}, {"g", "b", 2}, {"g", "end", 3}};
  const RefinedMesh refined = refine_mesh(Topology(mesh), {}, mesh, 2);
  EXPECT_EQ(refined.mesh.groups[1].first_face, 32);
  EXPECT_EQ(refined.mesh.groups[2].first_face, 48);
}

TEST(RefinedMesh, AnAttributeThatIsNotFiniteIsRefusedByName) {
  Mesh mesh = cube();
  Attribute heat{"heat", Values::Ones(8, 1), {}};
  heat.values(5, 0) = std::nan("");
  mesh.attributes.push_back(heat);
  const Topology topology(mesh);
  try {
    refine_mesh(topology, Scheme(), mesh, 1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::NotFinite);
    EXPECT_STREQ(error.what(), "row 5 of the attribute 'heat' is not finite");
  }
}

}  // namespace
}  // namespace batten
