#include "batten/mesh/moved_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "batten/error.h"
#include "batten/mesh/primitives.h"
#include "support/errors.h"
#include "support/shapes.h"

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

TEST(SameConnectivity, MayStartFacesElsewhereAndNothingElse) {
  const Mesh mesh = cube();
  test::Faces faces = test::faces_of(mesh);
  std::rotate(faces[2].begin(), faces[2].begin() + 1, faces[2].end());
  EXPECT_NO_THROW(require_same_connectivity(mesh, test::with_faces(mesh, faces)));
  std::swap(faces[3][0], faces[3][1]);
  test::expect_error([&] { require_same_connectivity(mesh, test::with_faces(mesh, faces)); }, ErrorCode::BadShape,
                     "face 3 joins");
  test::expect_error([&] { require_same_connectivity(mesh, octahedron()); }, ErrorCode::BadShape, "8 vertices");
  test::expect_error([&] { require_same_connectivity(mesh, test::without_face(mesh, 0)); }, ErrorCode::BadShape,
                     "6 faces");
}

}  // namespace
}  // namespace batten
