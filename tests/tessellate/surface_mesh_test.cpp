#include "batten/tessellate/surface_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "batten/io/io.h"
#include "batten/limit/limit_matrix.h"
#include "batten/mesh/primitives.h"
#include "batten/refine/refinement.h"

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

}  // namespace
}  // namespace batten
