#include "batten/mesh/primitives.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "batten/error.h"
#include "mesh/manifold.h"
#include "support/errors.h"

namespace batten {
namespace {

using test::code_of;

struct Solid {
  const char* name;
  Mesh mesh;
  Index vertices;
  Index faces;
  Index face_size;
  double edge;    ///< length
  double volume;  ///< closed form
};

std::vector<Solid> solids() {
  const double phi = std::numbers::phi;
  const double root2 = std::numbers::sqrt2;
  const double root5 = std::sqrt(5.0);
  const double short_edge = 2.0 / phi;
  return {{"tetrahedron", tetrahedron(), 4, 4, 3, 2.0 * root2, 8.0 / 3.0},
          {"cube", cube(), 8, 6, 4, 2.0, 8.0},
          {"octahedron", octahedron(), 6, 8, 3, root2, 4.0 / 3.0},
          {"icosahedron", icosahedron(), 12, 20, 3, 2.0, 5.0 / 12.0 * (3.0 + root5) * 8.0},
          {"dodecahedron", dodecahedron(), 20, 12, 5, short_edge,
           (15.0 + 7.0 * root5) / 4.0 * short_edge * short_edge * short_edge}};
}

TEST(Primitives, RegularSolidsAreClosedAndOutward) {
  for (const Solid& solid : solids()) {
    const test::ManifoldReport report = test::examine(solid.mesh);
    EXPECT_TRUE(report.valid) << solid.name << ": " << report.reason;
    EXPECT_EQ(report.euler, 2) << solid.name;
    EXPECT_EQ(report.boundary_edge_count, 0) << solid.name;
    EXPECT_EQ(solid.mesh.vertex_count(), solid.vertices) << solid.name;
    EXPECT_EQ(solid.mesh.face_count(), solid.faces) << solid.name;
    EXPECT_NEAR(report.volume, solid.volume, 1e-13 * solid.volume) << solid.name;
  }
}

TEST(Primitives, RegularSolidsAreRegular) {
  for (const Solid& solid : solids()) {
    const double radius = solid.mesh.points.row(0).norm();
    for (Index v = 0; v < solid.vertices; ++v)
      EXPECT_NEAR(solid.mesh.points.row(v).norm(), radius, 1e-15) << solid.name;
    for (Index f = 0; f < solid.faces; ++f) {
      ASSERT_EQ(solid.mesh.face_size(f), solid.face_size) << solid.name;
      for (Index c = 0; c < solid.face_size; ++c) {
        const Index a = solid.mesh.face_vertices[f * solid.face_size + c];
        const Index b = solid.mesh.face_vertices[f * solid.face_size + (c + 1) % solid.face_size];
        EXPECT_NEAR((solid.mesh.points.row(a) - solid.mesh.points.row(b)).norm(), solid.edge, 1e-15 * 4) << solid.name;
      }
    }
  }
}

TEST(Primitives, TorusHasOneHandleAndItsVolume) {
  const Mesh mesh = torus(200, 100, 2.0, 0.5);
  const test::ManifoldReport report = test::examine(mesh);
  EXPECT_TRUE(report.valid) << report.reason;
  EXPECT_EQ(report.euler, 0);
  EXPECT_EQ(report.boundary_edge_count, 0);
  // Inscribed polygons lose 2 pi^2 / (3 n^2) of the area.
  const double exact = 2.0 * std::numbers::pi * std::numbers::pi * 2.0 * 0.25;
  EXPECT_NEAR(report.volume, exact, 1e-3 * exact);
  EXPECT_LT(report.volume, exact);
}

TEST(Primitives, GridIsOneSheetFacingUp) {
  const Mesh mesh = grid(3, 2);
  const test::ManifoldReport report = test::examine(mesh);
  EXPECT_TRUE(report.valid) << report.reason;
  EXPECT_EQ(report.euler, 1);
  EXPECT_EQ(report.boundary_edge_count, 10);
  EXPECT_EQ(report.boundary_loop_count, 1);
  EXPECT_EQ(mesh.points.row(0), Eigen::RowVector3d(-1, -1, 0));
  EXPECT_EQ(mesh.points.row(3), Eigen::RowVector3d(1, -1, 0));
  EXPECT_EQ(mesh.points.row(11), Eigen::RowVector3d(1, 1, 0));
  const Eigen::Vector3d along = mesh.points.row(mesh.face_vertices[1]) - mesh.points.row(mesh.face_vertices[0]);
  const Eigen::Vector3d across = mesh.points.row(mesh.face_vertices[3]) - mesh.points.row(mesh.face_vertices[0]);
  EXPECT_GT(along.cross(across).z(), 0.0);
}

TEST(Primitives, RefuseWhatIsNoShape) {
  EXPECT_EQ(code_of([] { torus(2, 8); }), ErrorCode::BadArgument);
  EXPECT_EQ(code_of([] { torus(8, 2); }), ErrorCode::BadArgument);
  EXPECT_EQ(code_of([] { torus(8, 8, 1.0, 1.0); }), ErrorCode::BadArgument);
  EXPECT_EQ(code_of([] { torus(8, 8, 1.0, std::nan("")); }), ErrorCode::BadArgument);
  EXPECT_EQ(code_of([] { grid(0, 4); }), ErrorCode::BadArgument);
  EXPECT_EQ(code_of([] { grid(100000, 100000); }), ErrorCode::TooLarge);
}

}  // namespace
}  // namespace batten
