#include "batten/fit/simplified.h"

#include <gtest/gtest.h>

#include <numbers>

#include "batten/fit/matching.h"
#include "batten/fit/paired_quads.h"
#include "batten/fit/quad_turns.h"
#include "batten/mesh/primitives.h"
#include "batten/mesh/repair.h"
#include "batten/mesh/summary.h"
#include "batten/mesh/triangulate.h"
#include "fit/clouds.h"
#include "mesh/manifold.h"

namespace batten {
namespace {

/// A cube of n by n quads a side, as triangles.
Mesh fine_cube(Index n) {
  Mesh mesh;
  const Mesh side = grid(n, n);
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const double sign = face % 2 == 0 ? 1.0 : -1.0;
    const Index first = mesh.vertex_count();
    mesh.points.conservativeResize(first + side.vertex_count(), 3);
    for (Index v = 0; v < side.vertex_count(); ++v) {
      mesh.points(first + v, axis) = sign;
      mesh.points(first + v, (axis + 1) % 3) = sign * side.points(v, 0);
      mesh.points(first + v, (axis + 2) % 3) = side.points(v, 1);
    }
    for (Index f = 0; f < side.face_count(); ++f) {
      const Index* c = side.face_vertices.data() + side.face_offsets[f];
      mesh.add_face({first + c[0], first + c[1], first + c[2], first + c[3]});
    }
  }
  return triangulated(repair(mesh).mesh);
}

TEST(Simplified, KeepsACubeExactly) {
  const Mesh cube = simplified(fine_cube(8), 60);
  const test::ManifoldReport report = test::examine(cube);
  EXPECT_TRUE(report.valid) << report.reason;
  EXPECT_EQ(report.euler, 2);
  EXPECT_EQ(cube.vertex_count(), 60);
  EXPECT_NEAR(report.volume, 8.0, 0.03);
}

TEST(Simplified, KeepsGenusAndBoundaries) {
  const Mesh ring = simplified(triangulated(torus(60, 24)), 60);
  EXPECT_EQ(test::examine(ring).euler, 0);
  EXPECT_EQ(ring.vertex_count(), 60);
  const Mesh sheet = simplified(triangulated(grid(20, 20)), 30);
  const test::ManifoldReport report = test::examine(sheet);
  EXPECT_EQ(report.boundary_loop_count, 1);
  EXPECT_EQ(report.euler, 1);
  EXPECT_NEAR(sheet.points.col(0).maxCoeff(), 1.0, 0.01);
  EXPECT_NEAR(sheet.points.col(1).minCoeff(), -1.0, 0.01);
}

TEST(Simplified, StopsWhereTheTopologyNeedsTheVertices) {
  const Mesh least = simplified(triangulated(torus(12, 8)), 1);
  const test::ManifoldReport report = test::examine(least);
  EXPECT_TRUE(report.valid) << report.reason;
  EXPECT_EQ(report.euler, 0);
  EXPECT_GE(least.vertex_count(), 7) << "a torus has at least seven vertices";
}

/// Petersen: every bridgeless cubic graph, such as the dual of a closed triangle mesh, has a perfect matching.
TEST(PairedQuads, LeavesNoTriangleOnClosedSurfaces) {
  for (const Index vertices : {40, 100, 333}) {
    const Mesh quads = paired_quads(simplified(triangulated(torus(40, 20)), vertices));
    const test::ManifoldReport report = test::examine(quads);
    EXPECT_TRUE(report.valid) << report.reason;
    EXPECT_EQ(report.euler, 0);
    for (Index f = 0; f < quads.face_count(); ++f) EXPECT_EQ(quads.face_size(f), 4);
  }
}

TEST(PairedQuads, FindsTheGridThatWasCutUp) {
  const Mesh quads = paired_quads(triangulated(grid(6, 5)));
  EXPECT_EQ(quads.face_count(), 30);
}

TEST(QuadTurns, MakeQuadsMoreRegular) {
  Mesh quads = paired_quads(simplified(triangulated(torus(40, 20)), 200));
  const auto irregular = [](const Mesh& mesh) {
    const MeshSummary summary = summarize(Topology(mesh));
    return mesh.vertex_count() - summary.valences.at(4);
  };
  const Index before = irregular(quads);
  turn_quad_edges(quads);
  const test::ManifoldReport report = test::examine(quads);
  EXPECT_TRUE(report.valid) << report.reason;
  EXPECT_EQ(report.euler, 0);
  EXPECT_LT(irregular(quads), 0.85 * before);
  Mesh regular = torus(12, 8);
  const Buffer<Index> faces = regular.face_vertices;
  turn_quad_edges(regular);
  EXPECT_EQ(regular.face_vertices, faces) << "nothing is to be gained";
}

/// Petersen's graph, where greedy pairs get stuck, and a path whose inner pair is the cheapest.
TEST(Matching, FindsAsManyPairsAsThereAre) {
  std::vector<MatchedPair> pairs;
  for (Index i = 0; i < 5; ++i) {
    pairs.push_back({0.0, i, (i + 1) % 5});
    pairs.push_back({0.0, i, i + 5});
    pairs.push_back({0.0, i + 5, (i + 2) % 5 + 5});
  }
  for (const Index partner : maximum_matching(10, pairs, {})) EXPECT_GE(partner, 0);
  const std::vector<Index> path = maximum_matching(4, {{0.1, 1, 2}, {0.5, 0, 1}, {0.5, 2, 3}}, {0.3});
  EXPECT_EQ(path, (std::vector<Index>{1, 0, 3, 2}));
}

}  // namespace
}  // namespace batten
