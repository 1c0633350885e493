#include "batten/mesh/seams.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>
#include <vector>

#include "batten/mesh/primitives.h"
#include "batten/mesh/repair.h"

namespace batten {
namespace {

/// Each face with vertices of its own.
Mesh apart(const Mesh& mesh) {
  Mesh loose;
  loose.points.resize(static_cast<Eigen::Index>(mesh.face_vertices.size()), 3);
  loose.face_offsets = mesh.face_offsets;
  for (std::size_t c = 0; c < mesh.face_vertices.size(); ++c) {
    loose.points.row(static_cast<Eigen::Index>(c)) = mesh.points.row(mesh.face_vertices[c]);
    loose.face_vertices.push_back(static_cast<Index>(c));
  }
  return loose;
}

Index coincident(const Mesh& mesh) { return coincident_boundary_count(Topology(mesh), mesh.points); }

Index vertices_without_twins(const Mesh& mesh) { return mesh.vertex_count() - repair(mesh).mesh.vertex_count(); }

TEST(CoincidentBoundaryCount, IsSixteenForALooseCube) {
  EXPECT_EQ(coincident(apart(cube())), 24 - 8);
  EXPECT_EQ(coincident(cube()), 0);
  EXPECT_EQ(coincident(grid(3, 4)), 0);
}

TEST(CoincidentBoundaryCount, IsWhatWeldingJoins) {
  for (const Mesh& mesh : {torus(7, 5), grid(4, 6), icosahedron()}) {
    const Mesh loose = apart(mesh);
    EXPECT_EQ(coincident(loose), vertices_without_twins(loose));
    EXPECT_GT(coincident(loose), 0);
  }
}

TEST(CoincidentBoundaryCount, LeavesOutFacesThatTouchAtAPoint) {
  Mesh mesh;
  mesh.points.resize(6, 3);
  mesh.points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, -1, 0;
  mesh.add_face({0, 1, 2});
  mesh.add_face({3, 4, 5});
  EXPECT_EQ(coincident(mesh), 0);
  EXPECT_EQ(vertices_without_twins(mesh), 0);
}

TEST(CoincidentBoundaryCount, TakesMinusZeroForZero) {
  Mesh mesh;
  mesh.points.resize(6, 3);
  mesh.points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -0.0, 0, 1, -0.0, 0, 0, -1, 0;
  mesh.add_face({0, 1, 2});
  mesh.add_face({4, 3, 5});
  EXPECT_EQ(coincident(mesh), 2);
}

}  // namespace
}  // namespace batten
