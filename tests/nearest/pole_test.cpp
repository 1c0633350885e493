/// Nearest points beside vertices of high valence.
#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "batten/nearest/cell_shapes.h"
#include "nearest/nearest_test_tools.h"

namespace batten {
namespace {

using nearest_tests::expect_nearest;
using nearest_tests::random_queries;

constexpr Index kPoleValence = 300;

/// Two polygons of so many corners, joined by quads: after the first step their middles are vertices of that valence.
Mesh drum(Index corners) {
  test::Faces faces(2);
  for (Index i = 0; i < corners; ++i) faces[0].push_back(corners - 1 - i);
  for (Index i = 0; i < corners; ++i) faces[1].push_back(corners + i);
  for (Index i = 0; i < corners; ++i) {
    const Index next = (i + 1) % corners;
    faces.push_back({i, next, corners + next, corners + i});
  }
  Mesh mesh = test::mesh_of_faces(2 * corners, faces);
  for (Index v = 0; v < 2 * corners; ++v) {
    const double angle = 2.0 * std::numbers::pi * v / corners;
    mesh.points.row(v) << std::cos(angle), std::sin(angle), v < corners ? -0.5 : 0.5 + 0.1 * std::cos(2.0 * angle);
  }
  return mesh;
}

TEST(NearestPointPole, NoSampleIsNearerThanTheAnswerBesidePolygonsOfManyCorners) {
  const Mesh mesh = drum(kPoleValence);
  expect_nearest(mesh, Scheme(), 3, random_queries(mesh, 20, 1));
}

TEST(NearestPointPole, NoSampleIsNearerThanTheAnswerBesideFansOfManyTriangles) {
  const Mesh mesh = test::bipyramid(kPoleValence);
  Scheme scheme;
  scheme.kind = SchemeKind::Loop;
  expect_nearest(mesh, scheme, 3, random_queries(mesh, 20, 2));
}

/// A vertex of valence N has rings of about 2 N points (N points). No shape keeps more than 64 weights for each of
/// them: the memory is linear in N.
template <typename Net>
void expect_few_weights(const Topology& base, const Scheme& scheme) {
  const SurfacePatches patches(base, scheme);
  const Pieces& pieces = patches.pieces();
  const CellShapes<Net> shapes(patches);
  ASSERT_GE(shapes.most_points(), kPoleValence);
  for (const Piece* piece = pieces.begin(0); piece != pieces.end(base.face_count() - 1); ++piece) {
    if (piece->kind == Piece::Kind::Patch) continue;
    const auto range = shapes.irregular(piece->shared_ring);
    for (Index i = range.first; i < range.first + range.count; ++i) {
      ASSERT_LE(shapes.shape(i).weights.weights.size(), 64U * static_cast<std::size_t>(shapes.most_points()));
    }
  }
}

TEST(NearestPointPole, TakesMemoryInProportionToTheValence) {
  const Topology quads(drum(kPoleValence));
  const Scheme scheme;
  expect_few_weights<QuadNet>(Refinement(quads, scheme).child(), scheme.after_first_step());
  Scheme loop;
  loop.kind = SchemeKind::Loop;
  expect_few_weights<TriangleNet>(Topology(test::bipyramid(kPoleValence)), loop);
}

}  // namespace
}  // namespace batten
