/// Nearest points beside vertices of high valence.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "batten/limit/limit_matrix.h"
#include "batten/nearest/cell_shapes.h"
#include "nearest/nearest_test_tools.h"

namespace batten {
namespace {

using nearest_tests::expect_nearest;
using nearest_tests::random_queries;

constexpr Index kPoleValence = 300;
constexpr Index kHighValence = 5000;

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

/// A ring at a vertex of high valence has the faces near its own only: no shape has more weights than it takes to halve
/// such a ring once.
template <typename Net>
void expect_few_weights(const Topology& base, const Scheme& scheme) {
  const SurfacePatches patches(base, scheme);
  const Pieces& pieces = patches.pieces();
  const CellShapes<Net> shapes(patches);
  ASSERT_LE(shapes.most_points(), 5 * Poles::kWidth);
  for (const Piece* piece = pieces.begin(0); piece != pieces.end(base.face_count() - 1); ++piece) {
    if (piece->kind == Piece::Kind::Patch) continue;
    const auto range = shapes.irregular(piece->shared_ring);
    for (Index i = range.first; i < range.first + range.count; ++i) {
      ASSERT_LE(shapes.shape(i).weights.weights.size(), 16U * static_cast<std::size_t>(shapes.most_points()));
    }
  }
}

TEST(NearestPointPole, HasShapesWhoseMemoryDoesNotGrowWithTheValence) {
  const Topology quads(drum(kHighValence));
  const Scheme scheme;
  expect_few_weights<QuadNet>(Refinement(quads, scheme).child(), scheme.after_first_step());
  expect_few_weights<TriangleNet>(Topology(test::bipyramid(kHighValence)), Scheme{SchemeKind::Loop});
}

/// Queries above a pole, near the surface around it and far from both.
Points queries_at_pole(const Eigen::RowVector3d& pole) {
  Points queries(12, 3);
  for (Index i = 0; i < 4; ++i) {
    const double angle = 0.3 + 1.7 * i;
    const double radius = std::pow(10.0, -3.0 * i);
    const Eigen::RowVector3d aside(radius * std::cos(angle), radius * std::sin(angle), 0.0);
    queries.row(3 * i) = pole + aside;
    queries.row(3 * i + 1) = pole + aside + Eigen::RowVector3d(0.0, 0.0, 0.2);
    queries.row(3 * i + 2) = pole + aside - Eigen::RowVector3d(0.0, 0.0, 0.1);
  }
  return queries;
}

/// Where the nearest point is inside of a face, the query is on the surface's normal there.
void expect_right_angles(const Mesh& mesh, const Scheme& scheme, const Points& queries) {
  const SurfacePatches patches(Topology(mesh), scheme);
  const LimitSurface surface(patches, mesh.points);
  const NearestPoints nearest(patches, mesh.points);
  for (Eigen::Index i = 0; i < queries.rows(); ++i) {
    SCOPED_TRACE(i);
    const Eigen::Vector3d query = queries.row(i).transpose();
    const NearestPoint found = nearest.nearest(query);
    const Jet jet = surface.jet(found.place);
    // Where the squared distance is within the tolerance of its minimum, its slope may be about the square root.
    const double most = std::sqrt(2.0 * found.distance * nearest.tolerance()) + nearest.tolerance();
    if (!jet.regular) continue;
    EXPECT_LE(std::abs((jet.point - query).dot(jet.du.normalized())), 2.0 * most);
    EXPECT_LE(std::abs((jet.point - query).dot(jet.dv.normalized())), 2.0 * most);
  }
}

/// In seconds: each face at the pole has a part of the ring only, and boxes as slender as itself.
void expect_nearest_at_pole(const Mesh& mesh, const Scheme& scheme, const Eigen::RowVector3d& pole) {
  const Points queries = queries_at_pole(pole);
  const Points random = random_queries(mesh, 20, 3);
  Points all(queries.rows() + random.rows(), 3);
  all << queries, random;
  expect_nearest(mesh, scheme, 2, all);
  expect_right_angles(mesh, scheme, queries);
}

TEST(NearestPointPole, IsFoundBesidePolygonsOfFiveThousandCorners) {
  expect_nearest_at_pole(drum(kHighValence), Scheme(), {0.0, 0.0, 0.5});
}

TEST(NearestPointPole, IsFoundBesideFansOfFiveThousandTriangles) {
  expect_nearest_at_pole(test::bipyramid(kHighValence), Scheme{SchemeKind::Loop}, {0.0, 0.0, 0.6});
}

/// Along the axis of symmetry the nearest point is the pole itself.
TEST(NearestPointPole, IsThePoleOnItsAxis) {
  for (const SchemeKind kind : {SchemeKind::CatmullClark, SchemeKind::Loop}) {
    const Mesh mesh = test::bipyramid(kHighValence);
    const Topology topology(mesh);
    const Scheme scheme{kind};
    const NearestPoints nearest(topology, scheme, mesh.points);
    const Eigen::Vector3d pole = LimitMatrix(topology, scheme).apply(mesh.points).row(kHighValence).transpose();
    const NearestPoint found = nearest.nearest({0.0, 0.0, 3.0});
    EXPECT_LE((found.point - pole).norm(), 1e-12);
    EXPECT_NEAR(found.distance, 3.0 - pole[2], 1e-12);
  }
}

}  // namespace
}  // namespace batten
