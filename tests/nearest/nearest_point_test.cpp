#include "batten/nearest/nearest_point.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "batten/error.h"
#include "batten/io/io.h"
#include "batten/limit/limit_matrix.h"
#include "batten/parallel/parallel.h"
#include "batten/tessellate/tessellator.h"
#include "support/shapes.h"

namespace batten {
namespace {

/// Points of the drawn surface on a uniform grid.
struct Samples {
  Buffer<double> points;  ///< three numbers each

  Samples(const Topology& topology, const Scheme& scheme, ConstValuesRef control, int levels, bool all_drawn = false) {
    const Tessellator tessellator(topology, scheme, levels);
    points.resize(3 * static_cast<std::size_t>(tessellator.vertex_count()));
    tessellator.limit<double>(control, points);
    if (all_drawn) return;
    Buffer<Index> faces(static_cast<std::size_t>(tessellator.face_count()) *
                        static_cast<std::size_t>(tessellator.face_size()));
    tessellator.faces(faces);
    const Buffer<double> all = std::move(points);
    points = Buffer<double>();
    for (const Index v : faces) points.insert(points.end(), {all[3 * v], all[3 * v + 1], all[3 * v + 2]});
  }
  std::ptrdiff_t count() const { return static_cast<std::ptrdiff_t>(points.size() / 3); }

  double nearest_distance(const Eigen::Vector3d& query) const {
    const auto least = [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
      double squared = std::numeric_limits<double>::infinity();
      for (const double* p = &points[3 * begin]; p != points.data() + 3 * end; p += 3) {
        const double x = p[0] - query[0];
        const double y = p[1] - query[1];
        const double z = p[2] - query[2];
        squared = std::min(squared, x * x + y * y + z * z);
      }
      return squared;
    };
    return std::sqrt(parallel_reduce(
        count(), std::numeric_limits<double>::infinity(), least, [](double a, double b) { return std::min(a, b); },
        1 << 18));
  }
};

/// Around the mesh, half of them near its points.
Points random_queries(const Mesh& mesh, Index count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const double diagonal = bounding_diagonal(mesh.points);
  const Eigen::RowVector3d centre = mesh.points.colwise().mean();
  Points queries(count, 3);
  for (Index i = 0; i < count; ++i) {
    const Eigen::RowVector3d shift(normal(random), normal(random), normal(random));
    const auto vertex = static_cast<Index>(random() % static_cast<unsigned>(mesh.vertex_count()));
    queries.row(i) = i % 2 == 0 ? Eigen::RowVector3d(mesh.points.row(vertex) + 0.05 * diagonal * shift)
                                : Eigen::RowVector3d(centre + 0.5 * diagonal * shift);
  }
  return queries;
}

/// Of the dihedron's two sheets, which fold along their rim: there the surface has no tangent plane.
constexpr double kFoldTolerance = 1e-6;

/// What must hold of any answer: it is a point of the surface at its distance, no sample is nearer, and the proof
/// leaves no more than the tolerance open.
void expect_nearest(const Mesh& mesh, const Scheme& scheme, int levels, const Points& queries, double tolerance = 0.0) {
  const Topology topology(mesh);
  const LimitSurface surface(topology, scheme, mesh.points);
  const NearestPoints nearest(topology, scheme, mesh.points);
  const Samples samples(topology, scheme, mesh.points, levels);
  std::vector<NearestPoint> found(static_cast<std::size_t>(queries.rows()));
  nearest.nearest(queries, found);
  const double diagonal = bounding_diagonal(mesh.points);
  for (Eigen::Index i = 0; i < queries.rows(); ++i) {
    SCOPED_TRACE(i);
    const Eigen::Vector3d query = queries.row(i).transpose();
    const NearestPoint& answer = found[static_cast<std::size_t>(i)];
    EXPECT_LE((surface.jet(answer.place).point - answer.point).norm(), 1e-10 * diagonal);
    EXPECT_NEAR((query - answer.point).norm(), answer.distance, 1e-14 * (diagonal + query.norm()));
    EXPECT_LE(answer.distance, samples.nearest_distance(query) + nearest.tolerance());
    EXPECT_LE(answer.least_distance, answer.distance);
    EXPECT_LE(answer.distance - answer.least_distance, std::max(1.001 * nearest.tolerance(), tolerance));
  }
}

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

/// The plan's 10 M samples, on a model of the project.
TEST(NearestPoint, NoneOfTenMillionSamplesIsNearer) {
  const Mesh mesh = read_mesh(std::string(BATTEN_SOURCE_DIR) + "/models/creature.obj");
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

ErrorCode code_of(const std::function<void()>& work, const std::string& words) {
  try {
    work();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    return error.code();
  }
  ADD_FAILURE() << "no error";
  return ErrorCode::Cancelled;
}

TEST(NearestPoint, RefusesWhatHasNoNearestPoint) {
  Mesh mesh = cube();
  const Topology topology(mesh);
  const NearestPoints nearest(topology, Scheme(), mesh.points);
  Points queries = Points::Zero(3, 3);
  queries(2, 1) = std::numeric_limits<double>::quiet_NaN();
  std::vector<NearestPoint> found(3);
  EXPECT_EQ(code_of([&] { nearest.nearest(queries, found); }, "row 2"), ErrorCode::NotFinite);
  found.resize(2);
  EXPECT_EQ(code_of([&] { nearest.nearest(Points::Zero(3, 3), found); }, "3 queries"), ErrorCode::BadShape);
  EXPECT_EQ(code_of([&] { nearest.nearest(Values::Zero(2, 2), found); }, "three columns"), ErrorCode::BadShape);
  const auto build = [&] { NearestPoints(Topology(mesh), Scheme(), mesh.points); };
  mesh.holes = {0, 1, 2, 3, 4, 5};
  EXPECT_EQ(code_of(build, "holes"), ErrorCode::BadArgument);
  mesh.face_vertices.clear();
  mesh.face_offsets = {0};
  mesh.holes.clear();
  EXPECT_EQ(code_of(build, "no faces"), ErrorCode::BadArgument);
}

}  // namespace
}  // namespace batten
