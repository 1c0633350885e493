#include "batten/mesh/triangulate.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "batten/io/io.h"
#include "batten/mesh/primitives.h"
#include "batten/mesh/topology.h"
#include "support/shapes.h"

namespace batten {
namespace {

TEST(Triangulated, TakesTheShorterDiagonal) {
  Mesh mesh = test::mesh_of_faces(4, {{0, 1, 2, 3}});
  mesh.points << 0, 0, 0, 2, -1, 0, 4, 0, 0, 2, 1, 0;
  EXPECT_EQ(test::faces_of(triangulated(mesh)), (test::Faces{{0, 1, 3}, {1, 2, 3}}));
}

/// The short diagonal of an arrowhead may lie outside of it.
TEST(Triangulated, DoesNotFoldAnArrowhead) {
  Mesh mesh = test::mesh_of_faces(4, {{0, 1, 2, 3}});
  mesh.points << 0, 0, 0, 5, 1, 0, 0, 2, 0, 4, 1, 0;  // 0 to 2 is 2 long, 1 to 3 is 1: both ways it must be 1 to 3
  EXPECT_EQ(test::faces_of(triangulated(mesh)), (test::Faces{{0, 1, 3}, {1, 2, 3}}));
  mesh.points << 0, 0, 0, 5, 1, 0, 0, 2, 0, 1, 1, 0;  // now 0 to 2 is the shorter one, and outside
  EXPECT_EQ(test::faces_of(triangulated(mesh)), (test::Faces{{0, 1, 3}, {1, 2, 3}}));
}

TEST(Triangulated, KnowsInsideFromOutsideFarFromTheOrigin) {
  Mesh mesh = test::mesh_of_faces(5, {{0, 1, 2, 3, 4}});
  mesh.points << 0, 0, 0, 4, 0, 0, 4, 4, 0, 2, 1, 0, 0, 4, 0;  // a notch at 3
  const test::Faces near = test::faces_of(triangulated(mesh));
  mesh.points.array() += 1e9;
  EXPECT_EQ(test::faces_of(triangulated(mesh)), near);
}

/// Two quads with the same two vertices at opposite corners, back to back: one diagonal each, not the same.
TEST(Triangulated, DoesNotMakeAnEdgeTwice) {
  Mesh mesh = test::mesh_of_faces(4, {{0, 1, 2, 3}, {3, 2, 1, 0}});
  mesh.points << 0, 0, 0, 2, 0, 0.1, 2, 2, 0, 0, 2, 0.1;
  const Topology topology(triangulated(mesh));
  EXPECT_EQ(topology.edge_count(), 6);
  EXPECT_EQ(topology.face_count(), 4);
}

TEST(Triangulated, SurfacesCanBeMadeOfTheShapes) {
  for (const test::NamedMesh& sample : test::sample_meshes()) {
    const Topology before(sample.mesh);
    const Topology after(triangulated(sample.mesh));
    EXPECT_EQ(after.uniform_face_size(), 3) << sample.name;
    EXPECT_EQ(after.vertex_count() - after.edge_count() + after.face_count(),
              before.vertex_count() - before.edge_count() + before.face_count())
        << sample.name;
  }
}

/// Its shorter diagonals would give an edge four triangles.
TEST(Triangulated, SuzanneStaysASurface) {
  const char* folder = std::getenv("BATTEN_DATA");
  if (folder == nullptr) GTEST_SKIP() << "set BATTEN_DATA to the folder of the test data";
  const Mesh mesh = read_mesh(std::string(folder) + "/meshes/suzanne.obj");
  EXPECT_EQ(Topology(triangulated(mesh)).uniform_face_size(), 3);
}

}  // namespace
}  // namespace batten
