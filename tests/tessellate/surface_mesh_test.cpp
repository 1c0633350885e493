#include "batten/tessellate/surface_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "batten/io/io.h"
#include "batten/limit/limit_matrix.h"
#include "batten/mesh/primitives.h"
#include "batten/mesh/triangulate.h"
#include "batten/refine/refinement.h"
#include "support/shapes.h"
#include "support/surface_mesh.h"

namespace batten {
namespace {

Eigen::RowVector3d face_normal(const Mesh& mesh, Index face) {
  const auto point = [&](Index i) -> Eigen::RowVector3d {
    return mesh.points.row(mesh.face_vertices[mesh.face_offsets[face] + i]);
  };
  return (point(2) - point(0)).cross(point(3) - point(1)).normalized();
}

TEST(SurfaceMesh, VerticesStayWhereTheLimitMatrixPutsThem) {
  Mesh mesh = torus(7, 5);
  mesh.attributes = {{"heat", mesh.points.col(1), {}}};
  const Topology topology(mesh);
  const Values limit = LimitMatrix(topology, {}).apply(mesh.points);
  for (const int levels : {0, 1, 3}) {
    const Mesh surface = surface_mesh(topology, {}, mesh, levels);
    // Refinement keeps limit positions, to rounding.
    EXPECT_LT((surface.points.topRows(35) - limit).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_LT((surface.attributes[0].values - surface.points.col(1)).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_FALSE(surface.scheme || surface.boundary);
  }
}

TEST(SurfaceMesh, NormalsAtCreasesAreThoseOfTheCornersSide) {
  Mesh mesh = cube();
  for (Index f = 0; f < 6; ++f) {
    for (Index i = 0; i < 4; ++i) {
      mesh.creases.push_back({mesh.face_vertices[4 * f + i], mesh.face_vertices[4 * f + (i + 1) % 4], 10.0});
    }
  }
  const Mesh surface = surface_mesh(Topology(mesh), {}, mesh, 2);
  ASSERT_EQ(surface.attributes.size(), 2U);
  const Attribute& normal = surface.attributes[1];
  ASSERT_TRUE(normal.per_corner());
  for (Index f = 0; f < surface.face_count(); ++f) {
    for (Index i = 4 * f; i < 4 * f + 4; ++i) {
      EXPECT_LT((normal.values.row(normal.corner_rows[i]) - face_normal(surface, f)).norm(), 1e-12);
    }
  }
}

TEST(SurfaceMesh, ASmoothSurfaceHasNormalsAtTheVerticesOnly) {
  const Mesh mesh = torus(7, 5);
  const Mesh surface = surface_mesh(Topology(mesh), {}, mesh, 1);
  ASSERT_EQ(surface.attributes.size(), 1U);
  EXPECT_FALSE(surface.attributes[0].per_corner());
}

/// With colours at the vertices, texture coordinates at the corners, with seams and a face without any, groups and
/// holes.
Mesh with_everything(Mesh mesh) {
  const Index faces = mesh.face_count();
  Buffer<Index> rows(mesh.face_vertices.size());
  for (std::size_t c = 0; c < rows.size(); ++c) rows[c] = static_cast<Index>(c % 7 == 0 ? c : mesh.face_vertices[c]);
  const Values uv = Values::Random(static_cast<Eigen::Index>(rows.size()) + mesh.vertex_count(), 2);
  if (faces > 2) std::fill(rows.begin() + mesh.face_offsets[1], rows.begin() + mesh.face_offsets[2], -1);
  mesh.attributes = {{"color", Values::Random(mesh.vertex_count(), 4), {}}, {"uv", uv, rows}};
  mesh.groups = {{"g", "first", 0}, {"usemtl", "red", faces / 3}, {"g", "second", faces / 2}, {"g", "last", faces - 1}};
  if (faces > 5) mesh.holes = {2, faces / 2};
  return mesh;
}

void expect_refined_limit(const Mesh& mesh, const Scheme& scheme, std::initializer_list<int> all_levels) {
  const Topology topology(mesh);
  for (const int levels : all_levels) {
    SCOPED_TRACE(std::to_string(levels) + " levels");
    const test::SurfaceMeshErrors errors = test::compare_surface_mesh(topology, scheme, mesh, levels);
    EXPECT_LE(errors.points, 1e-14);
    EXPECT_LE(errors.attributes, 1e-13);
    EXPECT_LE(errors.normals, 1e-8);
  }
}

TEST(SurfaceMesh, IsTheRefinedMeshMovedToTheLimit) {
  for (const test::NamedMesh& sample : test::sample_meshes()) {
    if (sample.name.find("dihedron") != std::string::npos) continue;  // no normals at valence 2
    for (const unsigned seed : {0U, 1U, 2U}) {
      SCOPED_TRACE(sample.name + " with tags " + std::to_string(seed));
      Mesh mesh = with_everything(sample.mesh);
      if (seed > 0) mesh = test::with_random_tags(std::move(mesh), seed);
      Scheme scheme;
      for (const BoundaryRule rule : {BoundaryRule::None, BoundaryRule::EdgeOnly, BoundaryRule::EdgeAndCorner}) {
        scheme.boundary = rule;
        scheme.kind = SchemeKind::CatmullClark;
        expect_refined_limit(mesh, scheme, {0, 1, 2});
        scheme.kind = SchemeKind::Loop;
        if (all_triangles(mesh)) expect_refined_limit(mesh, scheme, {0, 1, 2});
      }
    }
  }
}

TEST(SurfaceMesh, IsTheRefinedMeshUnderOtherRulesToo) {
  Mesh mesh = test::with_random_tags(with_everything(test::jittered(torus(7, 5), 0.02, 4)), 5);
  Scheme scheme;
  scheme.alpha = 0.5;
  expect_refined_limit(mesh, scheme, {1, 2});
  scheme = Scheme();
  scheme.crease_method = CreaseMethod::Chaikin;
  expect_refined_limit(mesh, scheme, {1, 4});
  scheme = Scheme();
  scheme.triangle_rule = TriangleRule::Smooth;
  expect_refined_limit(test::with_random_tags(with_everything(test::random_hull(30, 2)), 3), scheme, {1, 3});
}

TEST(SurfaceMesh, IsTheRefinedMeshUnderEveryFaceVaryingRule) {
  for (const test::NamedMesh& sample : test::sample_meshes()) {
    if (sample.name.find("dihedron") != std::string::npos) continue;  // no normals at valence 2
    const Mesh mesh = with_everything(sample.mesh);
    for (int rule = 0; rule < 5; ++rule) {
      SCOPED_TRACE(sample.name + ", rule " + std::to_string(rule));
      Scheme scheme;
      scheme.face_varying = static_cast<FaceVaryingRule>(rule);
      scheme.boundary = rule % 2 == 0 ? BoundaryRule::EdgeOnly : BoundaryRule::None;
      expect_refined_limit(mesh, scheme, {0, 1, 2});
      scheme.kind = SchemeKind::Loop;
      if (all_triangles(mesh)) expect_refined_limit(mesh, scheme, {0, 2});
    }
  }
}

TEST(SurfaceMesh, IsTheRefinedMeshForLinearValues) {
  for (const test::NamedMesh& sample : test::sample_meshes()) {
    if (sample.name.find("dihedron") != std::string::npos) continue;
    SCOPED_TRACE(sample.name);
    Mesh mesh = with_everything(sample.mesh);
    mesh.attributes[0].carry = CarryRule::Midpoint;
    Scheme scheme;
    expect_refined_limit(mesh, scheme, {0, 1, 3});
    scheme.kind = SchemeKind::Loop;
    if (all_triangles(mesh)) expect_refined_limit(mesh, scheme, {0, 1, 3});
  }
}

TEST(SurfaceMesh, IsTheRefinedMeshUnderTheButterflies) {
  for (const unsigned seed : {0U, 1U, 2U}) {
    Mesh mesh = with_everything(test::jittered(test::triangle_torus(7, 5), 0.02, 4));
    if (seed > 0) mesh = test::with_random_tags(std::move(mesh), seed);
    Scheme scheme;
    scheme.kind = SchemeKind::ModifiedButterfly;
    expect_refined_limit(mesh, scheme, {0, 1, 2});
    scheme.kind = SchemeKind::Butterfly;
    expect_refined_limit(mesh, scheme, {2});
  }
}

TEST(SurfaceMesh, HolesAreLeftOutAndGroupsMoveUp) {
  Mesh mesh = grid(3, 1);
  mesh.holes = {1};
  mesh.groups = {{"g", "a", 0}, {"g", "b", 2}};
  mesh.attributes = {{"uv", mesh.points.leftCols(2), mesh.face_vertices}};
  const Mesh surface = surface_mesh(Topology(mesh), {}, mesh, 1);
  EXPECT_EQ(surface.face_count(), 8);
  EXPECT_EQ(surface.groups[1].first_face, 4);
  // The first child of the last face stands at its first corner.
  EXPECT_EQ(surface.face_vertices[16], mesh.face_vertices[8]);
  EXPECT_EQ(surface.attributes[0].corner_rows[16], mesh.face_vertices[8]);
  EXPECT_EQ(surface.attributes[0].corner_rows.size(), 32U);
}

TEST(SurfaceMesh, HasAsManyLevelsAsFacesAllow) {
  const Topology topology(cube());
  EXPECT_EQ(levels_within(topology, 6 * 64.0, 5), 3);
  EXPECT_EQ(levels_within(topology, 6 * 64.0 - 1.0, 5), 2);
  EXPECT_EQ(levels_within(topology, 1e9, 5), 5);
  EXPECT_EQ(levels_within(topology, 1.0, 5), 0);
  EXPECT_EQ(picture_levels(topology), 5);
}

}  // namespace
}  // namespace batten
