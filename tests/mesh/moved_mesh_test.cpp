#include "batten/mesh/moved_mesh.h"

#include <gtest/gtest.h>

#include "batten/error.h"
#include "batten/mesh/primitives.h"

namespace batten {
namespace {

TEST(WithPoints, KeepsAllButTheOldNormals) {
  Mesh mesh = cube();
  mesh.creases = {{0, 1, 2.0}};
  mesh.corners = {{3, 1.0}};
  mesh.holes = {5};
  mesh.groups = {{"g", "side", 2}};
  mesh.material_libraries = {"paint.mtl"};
  mesh.boundary = BoundaryRule::EdgeOnly;
  mesh.attributes = {{"color", Values::Ones(8, 3), {}}, {"normal", Values::Ones(8, 3), {}}};
  const Points points = 2.0 * mesh.points;
  const Mesh moved = with_points(mesh, points);
  EXPECT_EQ(moved.points, points);
  EXPECT_EQ(moved.face_vertices, mesh.face_vertices);
  EXPECT_EQ(moved.creases.size(), 1U);
  EXPECT_EQ(moved.corners.size(), 1U);
  EXPECT_EQ(moved.holes, mesh.holes);
  EXPECT_EQ(moved.groups.size(), 1U);
  EXPECT_EQ(moved.material_libraries, mesh.material_libraries);
  EXPECT_EQ(moved.boundary, mesh.boundary);
  ASSERT_EQ(moved.attributes.size(), 1U);
  EXPECT_EQ(moved.attributes[0].name, "color");
  EXPECT_THROW(with_points(mesh, Points::Zero(3, 3)), Error);
}

}  // namespace
}  // namespace batten
