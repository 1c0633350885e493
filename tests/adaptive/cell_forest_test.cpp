#include "batten/adaptive/cell_forest.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "batten/adaptive/cell_faces.h"
#include "batten/error.h"
#include "batten/refine/refinement.h"
#include "support/shapes.h"

namespace batten {
namespace {

/// Quad and triangle bases, closed and open, with boundaries and poles.
std::vector<test::NamedMesh> bases() {
  std::vector<test::NamedMesh> found;
  for (const test::NamedMesh& sample : test::sample_meshes()) {
    const Topology topology(sample.mesh);
    if (topology.uniform_face_size() == 3 || topology.uniform_face_size() == 4) found.push_back(sample);
  }
  found.push_back({"pole", test::bipyramid(360)});
  return found;
}

void cut_at_random(CellForest& forest, int cuts, unsigned seed) {
  std::mt19937 random(seed);
  for (int i = 0; i < cuts; ++i) {
    const Buffer<Index> leaves = forest.leaves();
    // Mostly a recent one, so that it goes deep.
    const std::size_t last = leaves.size() - 1;
    const Index cell = leaves[random() % 3 == 0 ? random() % leaves.size()
                                                : last - random() % std::min<std::size_t>(leaves.size(), 4)];
    if (forest.level(cell) < 9) forest.split(cell);
  }
}

TEST(CellForest, NeighboursSeeEachOtherAndDifferByOneLevelAtMost) {
  for (const test::NamedMesh& base : bases()) {
    SCOPED_TRACE(base.name);
    const Topology topology(base.mesh);
    CellForest forest(topology);
    cut_at_random(forest, 60, 3);
    EXPECT_GE(forest.deepest_level(), 4);
    for (const Index cell : forest.leaves()) {
      for (int s = 0; s < forest.corner_count(); ++s) {
        const CellForest::Side across = forest.neighbour(cell, s);
        if (across.cell < 0) continue;
        const int step = forest.level(cell) - forest.level(across.cell);
        ASSERT_GE(step, 0);
        ASSERT_LE(step, 1);
        if (step == 1) {
          EXPECT_TRUE(forest.is_leaf(across.cell));
        } else {
          const CellForest::Side back = forest.neighbour(across.cell, across.side);
          EXPECT_EQ(back.cell, cell);
          EXPECT_EQ(back.side, s);
        }
        if (forest.is_leaf(across.cell) || step == 1) continue;
        for (const int half : {0, 1}) {
          const int n = forest.corner_count();
          EXPECT_TRUE(forest.is_leaf(forest.child(across.cell, (across.side + half) % n))) << "two levels apart";
        }
      }
    }
  }
}

TEST(CellForest, GivesOneVertexToOnePlace) {
  // Uniform cuts: the vertices are those of uniform refinement.
  for (const test::NamedMesh& base : bases()) {
    SCOPED_TRACE(base.name);
    const Topology topology(base.mesh);
    CellForest forest(topology);
    Scheme scheme;
    if (topology.uniform_face_size() == 3) scheme.kind = SchemeKind::Loop;
    std::vector<Topology> levels{topology};
    for (int level = 0; level < 2; ++level) {
      for (const Index cell : forest.leaves()) forest.split(cell);
      levels.push_back(Refinement(levels.back(), scheme).child());
    }
    EXPECT_EQ(forest.leaves().size(), static_cast<std::size_t>(levels.back().face_count()));
    Index isolated = 0;
    for (Index v = 0; v < topology.vertex_count(); ++v) isolated += topology.is_isolated(v) ? 1 : 0;
    EXPECT_EQ(forest.vertex_count(), levels.back().vertex_count() - isolated);
  }
}

TEST(CellForest, LeavesOutFaces) {
  const Mesh mesh = grid(2, 1);
  const Topology topology(mesh);
  CellForest forest(topology, {0, 1});
  forest.split(0);
  EXPECT_EQ(forest.leaves().size(), 4U);
  EXPECT_EQ(forest.vertex_count(), 9);
  for (int s = 0; s < 4; ++s) EXPECT_EQ(forest.neighbour(0, s).cell, -1);
}

/// Every edge has two faces in opposite directions, or lies on the base's boundary: there are no cracks.
void expect_closed(const CellForest& forest, const CellFaces& faces) {
  const auto size = static_cast<std::size_t>(faces.size);
  std::set<std::pair<Index, Index>> edges;
  const auto edge = [&](std::size_t f, std::size_t k) {
    return std::pair(faces.vertices[f * size + k], faces.vertices[f * size + (k + 1) % size]);
  };
  for (std::size_t f = 0; f < faces.cells.size(); ++f) {
    for (std::size_t k = 0; k < size; ++k) EXPECT_TRUE(edges.insert(edge(f, k)).second) << "an edge twice";
  }
  const Topology& base = forest.base();
  double boundary = 0.0;
  for (std::size_t f = 0; f < faces.cells.size(); ++f) {
    for (std::size_t k = 0; k < size; ++k) {
      const std::pair<Index, Index> here = edge(f, k);
      if (edges.count({here.second, here.first}) > 0) continue;
      const std::array<double, 2> a = faces.places[f * size + k];
      const std::array<double, 2> b = faces.places[f * size + (k + 1) % size];
      boundary += std::max(std::abs(a[0] - b[0]), std::abs(a[1] - b[1]));  // its share of a base side
    }
  }
  Index expected = 0;
  for (Index e = 0; e < base.edge_count(); ++e) expected += base.is_boundary_edge(e) ? 1 : 0;
  EXPECT_EQ(boundary, expected) << "the open edges are not the base's boundary";
}

/// The faces' area in the base's parameters is the base's.
void expect_covered(const CellForest& forest, const CellFaces& faces) {
  const auto size = static_cast<std::size_t>(faces.size);
  double total = 0.0;
  for (std::size_t f = 0; f < faces.cells.size(); ++f) {
    double area = 0.0;
    for (std::size_t k = 0; k < size; ++k) {
      const std::array<double, 2> a = faces.places[f * size + k];
      const std::array<double, 2> b = faces.places[f * size + (k + 1) % size];
      area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    }
    EXPECT_GT(area, 0.0) << "a flat or turned face";
    total += area;
  }
  EXPECT_NEAR(total, forest.base().face_count() * (forest.corner_count() == 4 ? 1.0 : 0.5), 1e-9);
}

TEST(CellFaces, HaveNoCracksAndCoverTheBase) {
  for (const test::NamedMesh& base : bases()) {
    for (const unsigned seed : {1U, 2U, 3U}) {
      SCOPED_TRACE(base.name);
      const Topology topology(base.mesh);
      CellForest forest(topology);
      cut_at_random(forest, 10 * static_cast<int>(seed) * static_cast<int>(seed), seed);
      const Points points = Points::Random(forest.vertex_count(), 3);
      for (const CellFaces& faces : {triangles_of(forest, points), quads_of(forest)}) {
        expect_closed(forest, faces);
        expect_covered(forest, faces);
      }
      EXPECT_EQ(quads_of(forest).size, 4);
    }
  }
}

TEST(CellFaces, OfAddedVerticesHaveOneEach) {
  const Mesh mesh = cube();
  const Topology topology(mesh);
  CellForest forest(topology);
  cut_at_random(forest, 30, 5);
  const CellFaces faces = quads_of(forest);
  std::set<Index> met(faces.vertices.begin(), faces.vertices.end());
  EXPECT_EQ(met.size(), static_cast<std::size_t>(forest.vertex_count()) + faces.added.size());
  EXPECT_EQ(*met.rbegin() + 1, static_cast<Index>(met.size()));
  // A closed surface of genus 0, of quads.
  EXPECT_EQ(static_cast<Index>(met.size()) - faces.count(), 2);
}

TEST(CellForest, RefusesWhatItCannotCut) {
  const Mesh mesh = dodecahedron();
  const Topology topology(mesh);
  EXPECT_THROW(CellForest{topology}, Error);
  const Mesh quad = grid(1, 1);
  const Topology single(quad);
  EXPECT_THROW(CellForest(single, {0, 0}), Error);
  CellForest forest(single);
  Index cell = 0;
  for (int level = 0; level < CellForest::kMostLevels; ++level) {
    forest.split(cell);
    cell = forest.child(cell, 1);
  }
  EXPECT_THROW(forest.split(cell), Error);
}

}  // namespace
}  // namespace batten
