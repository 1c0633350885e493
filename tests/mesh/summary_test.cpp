#include "batten/mesh/summary.h"

#include <gtest/gtest.h>

#include "batten/mesh/places.h"
#include "support/shapes.h"

namespace batten {
namespace {

TEST(Summary, KnowsHandlesAndHolesOfEachComponent) {
  struct Expected {
    Mesh mesh;
    Index genus;
    Index loops;
  };
  for (const Expected& expected :
       {Expected{cube(), 0, 0}, Expected{torus(7, 5), 1, 0}, Expected{grid(3, 2), 0, 1},
        Expected{test::annulus(6), 0, 2}, Expected{test::without_face(test::without_face(torus(7, 5), 20), 0), 1, 2}}) {
    const MeshSummary summary = summarize(Topology(expected.mesh));
    ASSERT_EQ(summary.components.size(), 1U);
    EXPECT_EQ(summary.components[0].genus(), expected.genus);
    EXPECT_EQ(summary.components[0].boundary_loops, expected.loops);
    EXPECT_EQ(summary.components[0].closed(), expected.loops == 0);
    EXPECT_EQ(summary.components[0].faces, expected.mesh.face_count());
  }
}

TEST(Summary, CountsComponentsIsolatedVerticesAndValences) {
  const Mesh mesh = test::mesh_of_faces(9, {{0, 1, 2}, {0, 2, 3}, {5, 6, 7, 8}});
  const MeshSummary summary = summarize(Topology(mesh));
  ASSERT_EQ(summary.components.size(), 2U);
  EXPECT_EQ(summary.components[1].first_vertex, 5);
  EXPECT_EQ(summary.isolated_vertices, 1);
  EXPECT_EQ(summary.boundary_edges, 8);
  EXPECT_EQ(summary.boundary_loops, 2);
  EXPECT_EQ(summary.boundary_valences, (std::map<Index, Index>{{2, 6}, {3, 2}}));
  EXPECT_TRUE(summary.valences.empty());
}

TEST(Summary, CountsCreasesInsideAndDarts) {
  Mesh mesh = grid(3, 3);  // inside: 5, 6, 9, 10
  mesh.creases = {{5, 6, 2.5}, {6, 10, 12.0}, {0, 1, 3.0}, {9, 10, 0.0}};
  const MeshSummary summary = summarize(Topology(mesh));
  EXPECT_EQ(summary.sharp_edges, 2);
  EXPECT_EQ(summary.semi_sharp_edges, 1);
  EXPECT_EQ(summary.least_sharpness, 2.5F);
  EXPECT_EQ(summary.most_sharpness, kInfiniteSharpness);
  EXPECT_EQ(summary.darts, 2);
}

TEST(Places, CountsVerticesThatLieOnEarlierOnes) {
  Points points(5, 3);
  points << 0, 0, 0, 1, 0, 0, -0.0, 0, 0, 1, 0, 1e-300, 0, 0, 0;
  EXPECT_EQ(coincident_count(points), 2);
  points(0, 0) = std::nan("");
  EXPECT_EQ(coincident_count(points), 1);
}

/// So many points are sorted into parts first.
TEST(Places, TheFirstOfEqualPointsIsFoundAmongMany) {
  constexpr Index kCount = 100000;
  Points points(kCount, 3);
  for (Index v = 0; v < kCount; ++v) {
    const Index place = v < kCount / 2 ? v : (v * 7) % (kCount / 2);
    points.row(v) << 0.1 * (place % 100), 0.1 * (place / 100 % 100), place / 10000;
  }
  Buffer<Index> rows(kCount);
  for (Index v = 0; v < kCount; ++v) rows[v] = kCount - 1 - v;
  const Buffer<Index> first = first_equal(points, rows);
  std::map<Index, Index> met;
  for (Index i = 0; i < kCount; ++i) {
    const Index v = rows[i];
    const Index place = v < kCount / 2 ? v : (v * 7) % (kCount / 2);
    ASSERT_EQ(first[i], met.emplace(place, i).first->second) << i;
  }
  EXPECT_EQ(coincident_count(points), kCount / 2);
}

}  // namespace
}  // namespace batten
