#include "batten/nearest/nearest_point.h"

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <limits>
#include <random>

#include "batten/error.h"
#include "batten/io/io.h"
#include "batten/limit/limit_matrix.h"
#include "batten/parallel/parallel.h"
#include "batten/tessellate/tessellator.h"
#include "nearest/nearest_test_tools.h"
#include "support/errors.h"
#include "support/source_folder.h"

namespace batten {
namespace {

using nearest_tests::expect_nearest;
using nearest_tests::kFoldTolerance;
using nearest_tests::random_queries;
using nearest_tests::Samples;

TEST(NearestPoint, NoSampleIsNearer) {
  test::for_each_sample([](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    SCOPED_TRACE(name);
    const double tolerance = name.find("dihedron") == std::string::npos ? 0.0 : kFoldTolerance;
    expect_nearest(mesh, scheme, 4, random_queries(mesh, 60, 1), tolerance);
  });
}

TEST(NearestPoint, NoSampleIsNearerWithCreasesAndCornersOfAllSharpnesses) {
  test::for_each_sample([](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    SCOPED_TRACE(name);
    const double tolerance = name.find("dihedron") == std::string::npos ? 0.0 : kFoldTolerance;
    expect_nearest(test::with_random_tags(mesh, 3), scheme, 4, random_queries(mesh, 60, 2), tolerance);
  });
}

TEST(NearestPoint, FacesOfHolesAndLooseBoundariesAreNoPartOfTheSurface) {
  Mesh mesh = test::jittered(grid(6, 6), 0.1, 4);
  mesh.holes = {14, 15};
  Scheme scheme;
  expect_nearest(mesh, scheme, 4, random_queries(mesh, 60, 3));
  scheme.boundary = BoundaryRule::None;
  expect_nearest(mesh, scheme, 4, random_queries(mesh, 60, 4));
  mesh = test::jittered(test::without_face(dodecahedron(), 2), 0.05, 5);
  mesh.holes = {4};
  expect_nearest(mesh, Scheme(), 4, random_queries(mesh, 60, 5));
}

/// All cells are equally near: a search that looked at each would take 4 ms here, 8 s for all queries.
TEST(NearestPoint, ASurfaceThatIsAPointAnswersAtOnce) {
  Mesh mesh = torus(60, 40);
  const Points queries = random_queries(mesh, 2000, 6);
  const Eigen::RowVector3d place(1.0, 2.0, 3.0);
  mesh.points.rowwise() = place;
  const NearestPoints nearest(Topology(mesh), Scheme(), mesh.points);
  std::vector<NearestPoint> found(2000);
  const std::clock_t begin = std::clock();
  nearest.nearest(queries, found);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 1.0);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double distance = (queries.row(static_cast<Eigen::Index>(i)) - place).norm();
    EXPECT_NEAR(found[i].distance, distance, nearest.tolerance());
    EXPECT_NEAR(found[i].least_distance, distance, nearest.tolerance());
  }
}

/// The plan's 10 M samples, on a model of the project.
TEST(NearestPoint, NoneOfTenMillionSamplesIsNearer) {
  const Mesh mesh = read_mesh(test::source_folder() + "/models/creature.obj");
  const Topology topology(mesh);
  int levels = 1;
  for (Index corners = topology.half_edge_count(); corners < 10'000'000; corners *= 4) ++levels;
  const Samples samples(topology, Scheme(), mesh.points, levels, true);
  ASSERT_GE(samples.count(), 10'000'000);
  const NearestPoints nearest(topology, Scheme(), mesh.points);
  const Points queries = random_queries(mesh, 40, 6);
  for (Eigen::Index i = 0; i < queries.rows(); ++i) {
    const NearestPoint found = nearest.nearest(queries.row(i).transpose());
    const double brute = samples.nearest_distance(queries.row(i).transpose());
    EXPECT_LE(found.distance, brute + nearest.tolerance());
    EXPECT_GE(found.distance, brute - 1e-3 * nearest.diagonal());  // about the samples' spacing
  }
}

/// A cube with sharp edges only is its own limit surface.
TEST(NearestPoint, OfASharpCubeIsThatOfTheCube) {
  Mesh mesh = cube();
  const Topology topology(mesh);
  for (Index e = 0; e < topology.edge_count(); ++e) {
    const Index h = topology.edge_half_edge(e);
    mesh.creases.push_back({topology.origin(h), topology.destination(h), kInfiniteSharpness});
  }
  const Topology tagged(mesh);
  const NearestPoints nearest(tagged, Scheme(), mesh.points);
  const Eigen::Vector3d low = mesh.points.colwise().minCoeff().transpose();
  const Eigen::Vector3d high = mesh.points.colwise().maxCoeff().transpose();
  const Points queries = random_queries(mesh, 500, 7);
  for (Eigen::Index i = 0; i < queries.rows(); ++i) {
    const Eigen::Vector3d query = queries.row(i).transpose();
    const Eigen::Vector3d inside = query.cwiseMax(low).cwiseMin(high);
    const double expected =
        inside == query ? std::min((query - low).minCoeff(), (high - query).minCoeff()) : (query - inside).norm();
    const NearestPoint found = nearest.nearest(query);
    EXPECT_NEAR(found.distance, expected, nearest.tolerance());
    if (inside != query) {
      EXPECT_LE((found.point - inside).norm(), 1e-7);
    }
  }
}

TEST(NearestPoint, PointsOfTheSurfaceAreTheirOwn) {
  test::for_each_sample([](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    SCOPED_TRACE(name);
    const Topology topology(mesh);
    const LimitSurface surface(topology, scheme, mesh.points);
    const NearestPoints nearest(topology, scheme, mesh.points);
    std::mt19937 random(8);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (Index f = 0; f < surface.base().face_count(); ++f) {
      const double u = unit(random);
      const double v = unit(random) * (scheme.kind == SchemeKind::Loop ? 1.0 - u : 1.0);
      for (const SurfacePlace& place : {SurfacePlace{f, u, v}, SurfacePlace{f, 0.0, 0.0}, SurfacePlace{f, 1.0, 0.0}}) {
        const Eigen::Vector3d point = surface.jet(place).point;
        EXPECT_LE(nearest.nearest(point).distance, nearest.tolerance());
      }
    }
  });
}

/// Towards an extraordinary vertex along its normal: the nearest point is the vertex itself.
TEST(NearestPoint, ReachesExtraordinaryVertices) {
  for (const SchemeKind kind : {SchemeKind::CatmullClark, SchemeKind::Loop}) {
    const Mesh mesh = test::bipyramid(5);
    Scheme scheme;
    scheme.kind = kind;
    const Topology topology(mesh);
    const NearestPoints nearest(topology, scheme, mesh.points);
    const Eigen::Vector3d pole = LimitMatrix(topology, scheme).apply(mesh.points).row(5).transpose();
    const NearestPoint found = nearest.nearest({0.0, 0.0, 3.0});
    EXPECT_LE((found.point - pole).norm(), 1e-12);
    EXPECT_NEAR(found.distance, 3.0 - pole[2], 1e-12);
  }
}

TEST(NearestPoint, IsTheSameForAnyNumberOfThreads) {
  const Mesh mesh = test::random_hull(60, 2);
  const Topology topology(mesh);
  const Points queries = random_queries(mesh, 600, 9);
  std::vector<NearestPoint> many(600);
  std::vector<NearestPoint> one(600);
  NearestPoints(topology, Scheme(), mesh.points).nearest(queries, many);
  const ThreadLimit limit(1);
  NearestPoints(topology, Scheme(), mesh.points).nearest(queries, one);
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_EQ(one[i].distance, many[i].distance);
    ASSERT_EQ(one[i].place.face, many[i].place.face);
    ASSERT_EQ(one[i].place.u, many[i].place.u);
    ASSERT_EQ(one[i].place.v, many[i].place.v);
  }
}

TEST(NearestPoint, OfWhatIsFarAwayIsKnownToRounding) {
  const Mesh mesh = cube();
  const Topology topology(mesh);
  const NearestPoints nearest(topology, Scheme(), mesh.points);
  for (const double far : {1e3, 1e9, 1e30, 1e200}) {
    const NearestPoint found = nearest.nearest({far, 0.5 * far, 0.2 * far});
    EXPECT_NEAR(found.distance / (far * std::sqrt(1.29)), 1.0, 2.0 / far + 1e-12);
    EXPECT_LE(found.least_distance, found.distance);
    EXPECT_TRUE(found.point.allFinite());
  }
}

TEST(NearestPoint, TheUnitDoesNotMatter) {
  for (const double unit : {1e-30, 1.0, 1e30}) {
    Mesh mesh = torus(8, 6);
    const Points queries = random_queries(mesh, 50, 10) * unit;
    mesh.points *= unit;
    const Topology topology(mesh);
    const NearestPoints nearest(topology, Scheme(), mesh.points);
    const Samples samples(topology, Scheme(), mesh.points, 4);
    for (Eigen::Index i = 0; i < queries.rows(); ++i) {
      const NearestPoint found = nearest.nearest(queries.row(i).transpose());
      const double brute = samples.nearest_distance(queries.row(i).transpose());
      EXPECT_LE(found.distance, brute + nearest.tolerance());
      EXPECT_GE(found.distance, brute - 0.05 * unit);
      EXPECT_LE(found.distance - found.least_distance, 1.001 * nearest.tolerance());
    }
  }
}

TEST(NearestPoint, OfASurfaceThatIsAPointIsThePoint) {
  Mesh mesh = cube();
  mesh.points.rowwise() = Eigen::RowVector3d(1.0, 2.0, 3.0);
  const Topology topology(mesh);
  const NearestPoints nearest(topology, Scheme(), mesh.points);
  EXPECT_NEAR(nearest.nearest({1.0, 2.0, 5.0}).distance, 2.0, 1e-12);
}

TEST(NearestPoint, RefusesWhatHasNoNearestPoint) {
  Mesh mesh = cube();
  const Topology topology(mesh);
  const NearestPoints nearest(topology, Scheme(), mesh.points);
  Points queries = Points::Zero(3, 3);
  queries(2, 1) = std::numeric_limits<double>::quiet_NaN();
  std::vector<NearestPoint> found(3);
  test::expect_error([&] { nearest.nearest(queries, found); }, ErrorCode::NotFinite, "row 2");
  found.resize(2);
  test::expect_error([&] { nearest.nearest(Points::Zero(3, 3), found); }, ErrorCode::BadShape, "3 queries");
  test::expect_error([&] { nearest.nearest(Values::Zero(2, 2), found); }, ErrorCode::BadShape, "three columns");
  const auto build = [&] { NearestPoints(Topology(mesh), Scheme(), mesh.points); };
  mesh.holes = {0, 1, 2, 3, 4, 5};
  test::expect_error(build, ErrorCode::BadArgument, "holes");
  mesh.face_vertices.clear();
  mesh.face_offsets = {0};
  mesh.holes.clear();
  test::expect_error(build, ErrorCode::BadArgument, "no faces");
}

}  // namespace
}  // namespace batten
