#include "batten/mesh/repair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "batten/error.h"
#include "batten/mesh/check.h"
#include "mesh/manifold.h"
#include "support/shapes.h"

namespace batten {
namespace {

using test::Faces;
using test::faces_of;
using test::mesh_of_faces;
using test::with_faces;

void expect_same(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.face_offsets, b.face_offsets);
  EXPECT_EQ(a.face_vertices, b.face_vertices);
  ASSERT_EQ(a.creases.size(), b.creases.size());
  for (std::size_t i = 0; i < a.creases.size(); ++i) {
    EXPECT_EQ(a.creases[i].a, b.creases[i].a);
    EXPECT_EQ(a.creases[i].b, b.creases[i].b);
    EXPECT_EQ(a.creases[i].sharpness, b.creases[i].sharpness);
  }
  EXPECT_EQ(a.holes, b.holes);
  EXPECT_EQ(a.attributes.size(), b.attributes.size());
  EXPECT_EQ(a.groups.size(), b.groups.size());
}

/// The changes as text: "split-edges 2, split-vertices 4".
std::string words(const RepairResult& result) {
  std::string text;
  for (const RepairChange& change : result.changes) {
    text += (text.empty() ? "" : ", ") + repair_word(change.kind) + " " + std::to_string(change.count);
  }
  return text;
}

/// Topology accepts the result, its maps are right, and another repair changes nothing.
void expect_sound(const Mesh& input, const RepairResult& result, const RepairOptions& options = {}) {
  ASSERT_NO_THROW(Topology{result.mesh}) << words(result);
  ASSERT_EQ(static_cast<Index>(result.vertex_sources.size()), result.mesh.vertex_count());
  ASSERT_EQ(static_cast<Index>(result.face_sources.size()), result.mesh.face_count());
  for (Index v = 0; v < result.mesh.vertex_count(); ++v) {
    ASSERT_EQ(result.mesh.points.row(v), input.points.row(result.vertex_sources[v]));
  }
  ASSERT_TRUE(std::is_sorted(result.face_sources.begin(), result.face_sources.end()));
  const RepairResult again = repair(result.mesh, options);
  ASSERT_EQ(words(again), "") << "after " << words(result);
}

Mesh soup(const Mesh& mesh) {
  Mesh pieces;
  pieces.points.resize(static_cast<Eigen::Index>(mesh.face_vertices.size()), 3);
  for (std::size_t c = 0; c < mesh.face_vertices.size(); ++c) {
    pieces.points.row(static_cast<Eigen::Index>(c)) = mesh.points.row(mesh.face_vertices[c]);
    pieces.face_vertices.push_back(static_cast<Index>(c));
  }
  pieces.face_offsets = mesh.face_offsets;
  return pieces;
}

struct SoupKind {
  std::string name;
  Index vertices;
  unsigned faces;
  unsigned corners;
  int places;  ///< the number of places from which points are drawn, so that some coincide
  int trials;
};
void PrintTo(const SoupKind& kind, std::ostream* out) { *out << kind.name; }
class RandomSoup : public ::testing::TestWithParam<SoupKind> {};
INSTANTIATE_TEST_SUITE_P(Repair, RandomSoup,
                         ::testing::Values(SoupKind{"Few", 6, 4, 3, 100, 2000}, SoupKind{"Dense", 7, 14, 3, 100, 2000},
                                           SoupKind{"Polygons", 9, 10, 6, 100, 2000},
                                           SoupKind{"Coincident", 12, 10, 3, 6, 2000},
                                           SoupKind{"CoincidentPolygons", 14, 8, 5, 6, 2000},
                                           SoupKind{"Unwelded", 60, 20, 3, 7, 1500},
                                           SoupKind{"Large", 40, 120, 4, 30, 300}),
                         [](const auto& tested) { return tested.param.name; });

TEST_P(RandomSoup, IsAcceptedAndThenLeftAlone) {
  const SoupKind& kind = GetParam();
  std::mt19937 random(23);
  int changed = 0;
  for (int trial = 0; trial < kind.trials; ++trial) {
    Faces faces(1 + random() % kind.faces);
    for (auto& face : faces) {
      const unsigned size = random() % 40 == 0 ? random() % 3 : 3 + random() % (kind.corners - 2);
      for (unsigned i = 0; i < size; ++i) face.push_back(static_cast<Index>(random() % kind.vertices));
    }
    Mesh mesh = mesh_of_faces(kind.vertices, faces);
    for (Index v = 0; v < kind.vertices; ++v) {
      const auto place = static_cast<int>(random() % kind.places);
      mesh.points.row(v) << std::cos(place), std::sin(place * 1.7), std::cos(place * 2.3);
    }
    for (const double weld : {0.0, -1.0, 0.2}) {
      const RepairResult result = repair(mesh, {weld});
      expect_sound(mesh, result, {weld});
      if (HasFatalFailure()) FAIL() << "trial " << trial << ", weld " << weld;
      changed += result.changes.empty() ? 0 : 1;
    }
  }
  EXPECT_GT(changed, kind.trials);
}

test::ManifoldReport shape_of(const Mesh& mesh) { return test::examine(mesh); }

TEST(Repair, LeavesCleanMeshesAsTheyAre) {
  for (const test::NamedMesh& sample : test::sample_meshes()) {
    Mesh mesh = test::with_random_tags(sample.mesh, 5);
    // Topology accepts a vertex without a face, but repair drops it.
    if (connected_components(Topology(mesh)).count > 1) continue;
    mesh.groups = {{"g", "all", 0}, {"g", "none", mesh.face_count()}};
    mesh.attributes = {{"heat", Values::Random(mesh.vertex_count(), 2), {}}};
    const RepairResult result = repair(mesh);
    EXPECT_EQ(words(result), "") << sample.name;
    expect_same(result.mesh, mesh);
    EXPECT_EQ(result.mesh.attributes[0].values, mesh.attributes[0].values);
    EXPECT_TRUE(std::is_sorted(result.vertex_targets.begin(), result.vertex_targets.end()));
  }
}

TEST(Repair, WeldsATriangleSoupBackIntoTheSolid) {
  for (const Mesh& solid : {icosahedron(), dodecahedron(), torus(8, 6), test::random_hull(60, 3), grid(5, 4)}) {
    const RepairResult result = repair(soup(solid));
    expect_sound(soup(solid), result);
    EXPECT_EQ(result.mesh.vertex_count(), solid.vertex_count());
    EXPECT_EQ(words(result), "welded-vertices " + std::to_string(soup(solid).vertex_count() - solid.vertex_count()));
    EXPECT_EQ(shape_of(result.mesh).euler, shape_of(solid).euler);
    EXPECT_EQ(shape_of(result.mesh).boundary_loop_count, shape_of(solid).boundary_loop_count);
  }
}

TEST(Repair, WeldsOnlyWhenAsked) {
  const RepairResult result = repair(soup(icosahedron()), {-1.0});
  EXPECT_TRUE(result.changes.empty());
  EXPECT_EQ(result.mesh.vertex_count(), 60);
}

TEST(Repair, WeldsWithinADistanceOfTheDiagonal) {
  const Mesh pieces = test::jittered(soup(icosahedron()), 1e-6, 4);
  EXPECT_EQ(words(repair(pieces)), "");
  const RepairResult result = repair(pieces, {1e-5});
  expect_sound(pieces, result, {1e-5});
  EXPECT_EQ(result.mesh.vertex_count(), 12);
}

TEST(Repair, OrientsASoupOfRandomDirectionsOutwards) {
  std::mt19937 random(9);
  for (const Mesh& solid : {cube(), icosahedron(), torus(9, 7), test::random_hull(80, 6)}) {
    Faces faces = faces_of(soup(solid));
    for (auto& face : faces) {
      if (random() % 2 == 0) std::reverse(face.begin(), face.end());
    }
    const Mesh pieces = with_faces(soup(solid), faces);
    const RepairResult result = repair(pieces);
    expect_sound(pieces, result);
    EXPECT_EQ(shape_of(result.mesh).boundary_loop_count, 0);
    EXPECT_NEAR(shape_of(result.mesh).volume, shape_of(solid).volume, 1e-12 * shape_of(solid).volume);
  }
}

TEST(Repair, LeavesASolidThatIsInsideOutButConsistent) {
  Faces faces = faces_of(cube());
  for (auto& face : faces) std::reverse(face.begin(), face.end());
  EXPECT_EQ(words(repair(with_faces(cube(), faces))), "");
}

TEST(Repair, ReversesTheFaceThatDisagreesInAnOpenMesh) {
  Faces faces = faces_of(grid(4, 4));
  std::reverse(faces[5].begin(), faces[5].end());
  const RepairResult result = repair(with_faces(grid(4, 4), faces));
  ASSERT_EQ(words(result), "reversed-faces 1");
  EXPECT_EQ(result.changes[0].elements, std::vector<Index>{5});
  EXPECT_EQ(result.changes[0].text, "reversed 1 face to agree with the neighbours: 5");
}

/// Two unit cubes, joined by vertex number where they touch.
Mesh touching_cubes(const Eigen::RowVector3d& shift) {
  const Mesh one = cube();
  Mesh both = one;
  both.points.conservativeResize(16, 3);
  both.points.bottomRows(8) = one.points.rowwise() + shift;
  for (const auto& face : faces_of(one)) {
    std::vector<Index> moved;
    for (const Index v : face) {
      Index twin = v + 8;
      for (Index w = 0; w < 8; ++w) {
        if (both.points.row(w) == both.points.row(v + 8)) twin = w;
      }
      both.face_vertices.push_back(twin);
    }
    both.face_offsets.push_back(static_cast<Index>(both.face_vertices.size()));
  }
  return both;
}

void expect_two_solids(const Mesh& touching, const std::string& changes) {
  const RepairResult result = repair(touching);
  expect_sound(touching, result);
  EXPECT_EQ(words(result), changes);
  EXPECT_EQ(shape_of(result.mesh).component_count, 2);
  EXPECT_EQ(shape_of(result.mesh).boundary_loop_count, 0);
}

TEST(Repair, GivesTwoSolidsThatTouchInAnEdgeAnEdgeEach) {
  expect_two_solids(touching_cubes({2, 2, 0}), "split-edges 1, split-vertices 2, isolated-vertices 2");
}

TEST(Repair, GivesTwoSolidsThatTouchInAPointAVertexEach) {
  expect_two_solids(touching_cubes({2, 2, 2}), "split-vertices 1, isolated-vertices 1");
}

TEST(Repair, KeepsBothSidesOfAWallBetweenTwoSolids) {
  expect_two_solids(touching_cubes({2, 0, 0}), "split-edges 4, split-vertices 4, isolated-vertices 4");
}

TEST(Repair, TakesOneSideOfASheetThatIsGivenFromBothSides) {
  Faces faces = faces_of(grid(3, 3));
  for (std::size_t f = 0; f < 9; ++f) faces.emplace_back(faces[f].rbegin(), faces[f].rend());
  const Mesh mesh = with_faces(grid(3, 3), faces);
  const RepairResult result = repair(mesh);
  EXPECT_EQ(words(result), "repeated-faces 9");
  expect_same(result.mesh, grid(3, 3));
}

TEST(Repair, KeepsAPillow) { EXPECT_EQ(words(repair(test::dihedron(5))), ""); }

TEST(Repair, SplitsAFinFromTheFlatSheetItStandsOn) {
  Mesh mesh = grid(2, 2);  // the middle row's vertices are 3, 4, 5
  mesh.points.conservativeResize(11, 3);
  mesh.points.row(9) << -1, 0, 1;
  mesh.points.row(10) << 0, 0, 1;
  mesh.add_face({3, 4, 10, 9});
  const RepairResult result = repair(mesh);
  expect_sound(mesh, result);
  EXPECT_EQ(words(result), "split-edges 1, split-vertices 2");
  EXPECT_EQ(result.changes[0].elements, (std::vector<Index>{3, 4}));
  EXPECT_EQ(shape_of(result.mesh).component_count, 2);
  for (Index c = 0; c < 16; ++c) EXPECT_EQ(result.mesh.face_vertices[c], mesh.face_vertices[c]);
}

TEST(Repair, LetsCrossingSheetsPassThroughEachOther) {
  // Two planes cross in the edge (0, 1); no faces are connected elsewhere.
  Mesh mesh = mesh_of_faces(6, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {1, 0, 5}});
  mesh.points << 0, 0, 0, 0, 0, 1, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0;
  const RepairResult result = repair(mesh);
  expect_sound(mesh, result);
  const Faces faces = faces_of(result.mesh);
  EXPECT_EQ(faces[0][0], faces[1][1]);
  EXPECT_EQ(faces[2][0], faces[3][1]);
  EXPECT_NE(faces[0][0], faces[2][0]);
}

TEST(Repair, CutsAMoebiusStripOpenWhereItsOrientationJumps) {
  const Mesh strip = mesh_of_faces(8, {{0, 2, 3, 1}, {2, 4, 5, 3}, {4, 6, 7, 5}, {6, 1, 0, 7}});
  const RepairResult result = repair(strip);
  expect_sound(strip, result);
  EXPECT_EQ(words(result), "cut-edges 1, split-vertices 2");
  EXPECT_EQ(result.changes[0].elements, (std::vector<Index>{0, 1}));
  EXPECT_EQ(shape_of(result.mesh).euler, 1);
}

/// A torus' grid glued with a reflection.
Mesh klein_bottle(Index around, Index across) {
  Faces faces;
  for (Index i = 0; i < around; ++i) {
    for (Index j = 0; j < across; ++j) {
      const Index k = (j + 1) % across;
      const auto at = [&](Index row, Index column) {
        return row < around ? row * across + column : (across - column) % across;
      };
      faces.push_back({at(i, j), at(i + 1, j), at(i + 1, k), at(i, k)});
    }
  }
  return mesh_of_faces(around * across, faces);
}

TEST(Repair, CutsAKleinBottleAlongOneRing) {
  const Mesh bottle = klein_bottle(7, 6);
  const RepairResult result = repair(bottle);
  expect_sound(bottle, result);
  EXPECT_EQ(words(result), "cut-edges 6, split-vertices 6");
  EXPECT_EQ(shape_of(result.mesh).boundary_loop_count, 2);
  EXPECT_EQ(shape_of(result.mesh).component_count, 1);
}

TEST(Repair, SplitsAFaceThatTouchesItselfAndDropsWhatIsNone) {
  const Mesh mesh = mesh_of_faces(6, {{0, 1, 2, 0, 3, 4}, {1, 1, 0, 5}, {2, 3, 2}, {4, 5}});
  const RepairResult result = repair(mesh);
  expect_sound(mesh, result);
  EXPECT_EQ(words(result).substr(0, 39), "degenerate-faces 2, simplified-faces 2,");
  EXPECT_EQ(result.face_sources, (Buffer<Index>{0, 0, 1}));
  EXPECT_EQ(result.face_targets, (Buffer<Index>{0, 2, -1, -1}));
}

TEST(Repair, DropsFacesOnWhatDoesNotExistOrIsNotFinite) {
  Mesh mesh = cube();
  mesh.face_vertices[0] = 8;
  mesh.points(7, 1) = std::nan("");
  const RepairResult result = repair(mesh);
  ASSERT_NO_THROW(Topology{result.mesh});
  EXPECT_EQ(words(result), "bad-faces 4, isolated-vertices 2");
  EXPECT_EQ(result.vertex_targets[7], -1);
  EXPECT_EQ(result.mesh.face_count(), 2);
}

TEST(Repair, CarriesTagsAndAttributesAlong) {
  Mesh mesh = soup(grid(2, 1));  // corners 0 to 3 and 4 to 7; the vertices 1 = 4 and 2 = 7 meet
  mesh.creases = {{1, 2, 3.0}, {7, 4, 5.0}, {0, 2, 1.0}};
  mesh.corners = {{4, 2.0}};
  mesh.holes = {1, 9};
  mesh.groups = {{"g", "left", 0}, {"g", "right", 1}};
  Values uv(8, 2);
  for (Index v = 0; v < 8; ++v) uv.row(v) << v, 10 * v;
  mesh.attributes = {{"uv", uv, {}}, {"heat", uv, {}}};
  const RepairResult result = repair(mesh);
  expect_sound(mesh, result);
  EXPECT_EQ(words(result), "welded-vertices 2, dropped-tags 2");
  ASSERT_EQ(result.mesh.creases.size(), 1U);
  EXPECT_EQ(result.mesh.creases[0].sharpness, 5.0);
  EXPECT_EQ(std::minmax(result.mesh.creases[0].a, result.mesh.creases[0].b), std::minmax(1, 2));
  ASSERT_EQ(result.mesh.corners.size(), 1U);
  EXPECT_EQ(result.mesh.corners[0].vertex, 1);
  EXPECT_EQ(result.mesh.holes, std::vector<Index>{1});
  EXPECT_EQ(result.mesh.groups.size(), 2U);
  // The seam of the texture stays: every corner has its own coordinates.
  ASSERT_TRUE(result.mesh.attributes[0].per_corner());
  EXPECT_EQ(result.mesh.attributes[0].corner_rows, (Buffer<Index>{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(result.mesh.attributes[1].values.rows(), 6);
  EXPECT_EQ(result.mesh.attributes[1].values(1, 0), 1.0);
}

TEST(Repair, KeepsACreaseOnReversedFaces) {
  Faces faces = faces_of(cube());
  std::reverse(faces[0].begin(), faces[0].end());
  Mesh mesh = with_faces(cube(), faces);
  mesh.creases = {{0, 1, 2.0}, {1, 2, 3.0}, {2, 3, 4.0}};
  const RepairResult result = repair(mesh);
  EXPECT_EQ(words(result), "reversed-faces 1");
  expect_same(result.mesh, [&] {
    Mesh expected = mesh;
    std::reverse(expected.face_vertices.begin() + 1, expected.face_vertices.begin() + 4);
    return expected;
  }());
}

TEST(Repair, LeavesTwoLayersThatOnlyLieOnEachOther) {
  Mesh mesh = grid(2, 2);
  mesh.points.conservativeResize(18, 3);
  mesh.points.bottomRows(9) = grid(2, 2).points;
  for (const auto& face : faces_of(grid(2, 2))) mesh.add_face({face[3] + 9, face[2] + 9, face[1] + 9, face[0] + 9});
  EXPECT_EQ(words(repair(mesh)), "");
}

TEST(Repair, LeavesPointsWithoutFaces) { EXPECT_EQ(words(repair(mesh_of_faces(5, {}))), ""); }

TEST(Repair, RefusesArraysThatDoNotFit) {
  Mesh offsets = cube();
  offsets.face_offsets.back() = 20;
  EXPECT_THROW(repair(offsets), Error);
  Mesh rows = cube();
  rows.attributes = {{"color", Values::Zero(5, 3), {}}};
  EXPECT_THROW(repair(rows), Error);
  EXPECT_THROW(repair(cube(), {2.0}), Error);
}

}  // namespace
}  // namespace batten
