/// Everything in a Mesh survives writing and reading OBJ.
#include <limits>

#include "io/io_test_tools.h"

namespace batten::io_tests {
namespace {

/// A mesh with one of everything that OBJ knows.
Mesh rich_mesh() {
  Mesh mesh = random_mesh(50, 30);
  mesh.creases = {{0, 1, 2.5}, {3, 4, 10.0}, {5, 6, 0.1}};
  mesh.corners = {{7, 1.0 / 3.0}, {8, 10.0}};
  mesh.holes = {0, 29};
  mesh.boundary = BoundaryRule::EdgeOnly;
  mesh.crease_method = CreaseMethod::Chaikin;
  mesh.triangle_rule = TriangleRule::Smooth;
  mesh.face_varying = FaceVaryingRule::CornersPlus2;
  mesh.material_libraries = {"a.mtl", "b c.mtl"};
  mesh.groups = {{"o", "thing", 0}, {"g", "", 0}, {"usemtl", "red paint", 3}, {"s", "off", 3}, {"g", "end", 30}};
  mesh.attributes.push_back({"color", random_doubles(50, 4, 7), {}});
  Buffer<Index> rows(mesh.face_vertices.size());
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<Index>(i % 11) - 1;
  mesh.attributes.push_back({"uv", random_doubles(10, 2, 8), rows});
  for (Index& row : rows) row = row % 3 == 0 ? -1 : row;
  mesh.attributes.push_back({"normal", random_doubles(10, 3, 9), rows});
  return mesh;
}

TEST(ObjWriter, EverythingSurvives) { expect_same_mesh(rich_mesh(), round_trip(rich_mesh(), "obj")); }

TEST(ObjWriter, DoublesSurviveToTheBit) {
  const Mesh mesh = random_mesh(20000, 10000);
  expect_same_mesh(mesh, round_trip(mesh, "obj"));
}

TEST(ObjWriter, EveryBoundaryRuleSurvives) {
  for (const BoundaryRule rule : {BoundaryRule::None, BoundaryRule::EdgeAndCorner, BoundaryRule::EdgeOnly}) {
    Mesh mesh = random_mesh(3, 1);
    mesh.boundary = rule;
    mesh.crease_method = CreaseMethod::Uniform;
    mesh.triangle_rule = TriangleRule::Catmark;
    expect_same_tags(mesh, round_trip(mesh, "obj"));
  }
}

TEST(ObjWriter, EveryFaceVaryingRuleSurvives) {
  for (int rule = 0; rule < 6; ++rule) {
    Mesh mesh = random_mesh(3, 1);
    mesh.face_varying = static_cast<FaceVaryingRule>(rule);
    expect_same_tags(mesh, round_trip(mesh, "obj"));
  }
}

TEST(ObjWriter, VertexAttributesComeBackAtTheCorners) {
  Mesh mesh = random_mesh(20, 10);
  mesh.attributes.push_back({"normal", random_doubles(20, 3, 3), {}});
  const Mesh back = round_trip(mesh, "obj");
  ASSERT_EQ(back.attributes.size(), 1U);
  EXPECT_TRUE(same_bits(back.attributes[0].values, mesh.attributes[0].values));
  EXPECT_EQ(back.attributes[0].corner_rows, mesh.face_vertices);
}

TEST(ObjWriter, AnInfiniteSharpnessIsOpenSubdivsInfinity) {
  Mesh mesh = random_mesh(3, 1);
  mesh.creases = {{0, 1, std::numeric_limits<double>::infinity()}};
  EXPECT_EQ(round_trip(mesh, "obj").creases[0].sharpness, double{kInfiniteSharpness});
}

TEST(ObjWriter, APolygonOfAnySizeSurvives) {
  Mesh mesh = random_mesh(100000, 0);
  for (Index i = 0; i < 100000; ++i) mesh.face_vertices.push_back(i);
  mesh.face_offsets.push_back(100000);
  expect_same_mesh(mesh, round_trip(mesh, "obj"));
}

}  // namespace
}  // namespace batten::io_tests
