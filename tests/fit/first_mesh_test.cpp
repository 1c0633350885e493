#include "batten/fit/first_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "batten/io/io.h"
#include "batten/mesh/topology.h"
#include "fit/clouds.h"
#include "mesh/manifold.h"
#include "support/errors.h"

namespace batten {
namespace {

using test::CloudMaker;

/// What every first mesh must be: a manifold whose parts are those reported.
void expect_sound(const FirstMesh& found) {
  const test::ManifoldReport report = test::examine(found.mesh);
  EXPECT_TRUE(report.valid) << report.reason;
  EXPECT_NO_THROW(Topology{found.mesh});
  EXPECT_EQ(report.component_count, static_cast<Index>(found.parts.size()));
  Index loops = 0;
  Index vertices = 0;
  for (const FirstMeshPart& part : found.parts) {
    loops += part.boundary_loops;
    vertices += part.vertices;
  }
  EXPECT_EQ(report.boundary_loop_count, loops);
  EXPECT_EQ(found.mesh.vertex_count(), vertices);
  EXPECT_EQ(report.euler, 2 * static_cast<Index>(found.parts.size()) - 2 * found.genus() - loops);
  EXPECT_TRUE(found.mesh.points.allFinite());
}

void expect_closed(const FirstMesh& found, Index genus) {
  expect_sound(found);
  ASSERT_EQ(found.parts.size(), 1U);
  EXPECT_EQ(found.parts[0].genus, genus);
  EXPECT_EQ(found.parts[0].boundary_loops, 0);
  EXPECT_GT(test::examine(found.mesh).volume, 0.0) << "normals point inwards";
}

struct KnownCloud {
  const char* name;
  Points points;
  Index genus;
  double volume;
};

/// The vertices lie on the surface and the facets cut corners: the volume comes out too small, that of the thin torus
/// by a sixth.
TEST(FirstMesh, HasGenusAndVolumeOfKnownSurfaces) {
  const double pi = std::numbers::pi;
  FirstMeshOptions options;
  for (const KnownCloud& known : {KnownCloud{"sphere", CloudMaker().sphere(1500), 0, 4.0 / 3.0 * pi},
                                  KnownCloud{"torus", CloudMaker().torus(2000), 1, 2.0 * pi * pi * 0.35 * 0.35},
                                  KnownCloud{"thin torus", CloudMaker().torus(2000, 1.0, 0.1), 1, 0.02 * pi * pi},
                                  KnownCloud{"double torus", CloudMaker().double_torus(4000), 2, 0.0}}) {
    SCOPED_TRACE(known.name);
    options.faces = options.faces == FaceKind::Quads ? FaceKind::Triangles : FaceKind::Quads;
    const FirstMesh found = first_mesh({known.points, {}}, options);
    expect_closed(found, known.genus);
    EXPECT_NEAR(found.mesh.vertex_count(), options.vertices, 0.05 * options.vertices);
    if (known.volume == 0.0) continue;
    EXPECT_NEAR(test::examine(found.mesh).volume, known.volume, 0.2 * known.volume);
  }
}

/// The unit sphere again: no vertex farther than the depth of a cap over one face, about h^2 / 8 for edges of h.
TEST(FirstMesh, LiesOnTheSphere) {
  const FirstMesh found = first_mesh({CloudMaker().sphere(2000), {}});
  for (Index v = 0; v < found.mesh.vertex_count(); ++v) EXPECT_NEAR(found.mesh.points.row(v).norm(), 1.0, 0.01);
}

TEST(FirstMesh, TakesNormalsThatAreGiven) {
  PointCloud cloud{CloudMaker().torus(1500), {}};
  cloud.normals = estimate_normals(cloud.points);
  expect_closed(first_mesh(cloud), 1);
}

TEST(FirstMesh, DoesNotDependOnTheOrderOfPoints) {
  CloudMaker maker;
  const Points points = maker.with_outliers(maker.torus(800), 0.05);
  const FirstMesh found = first_mesh({points, {}});
  const FirstMesh again = first_mesh({maker.shuffled(points), {}});
  EXPECT_EQ(found.mesh.face_vertices, again.mesh.face_vertices);
  EXPECT_EQ(found.mesh.points, again.mesh.points);
}

/// Thinned clouds too: 60,000 points are more than are taken one by one.
TEST(FirstMesh, DoesNotDependOnTheOrderOfManyPoints) {
  CloudMaker maker;
  const Points points = maker.with_outliers(maker.torus(60000, 1.0, 0.2), 0.1);
  const FirstMesh found = first_mesh({points, {}});
  expect_closed(found, 1);
  const FirstMesh again = first_mesh({maker.shuffled(points), {}});
  EXPECT_EQ(found.mesh.points, again.mesh.points);
  EXPECT_EQ(found.outliers, again.outliers);
  EXPECT_GT(found.outliers, 3000);
}

TEST(FirstMesh, LeavesOutOutliers) {
  CloudMaker maker;
  for (const double share : {0.01, 0.1}) {
    const FirstMesh found = first_mesh({maker.with_outliers(maker.sphere(2000), share), {}});
    expect_closed(found, 0);
    EXPECT_GT(found.outliers, 0.5 * share * 2000);
    for (Index v = 0; v < found.mesh.vertex_count(); ++v) EXPECT_NEAR(found.mesh.points.row(v).norm(), 1.0, 0.1);
  }
}

TEST(FirstMesh, CountsPointsThatStandTwice) {
  const Points once = CloudMaker().sphere(800);
  Points twice(1600, 3);
  twice << once, once;
  const FirstMesh found = first_mesh({twice, {}});
  EXPECT_EQ(found.repeated_points, 800);
  EXPECT_EQ(found.mesh.points, first_mesh({once, {}}).mesh.points);
}

TEST(FirstMesh, FollowsMovesAndScales) {
  const Points points = CloudMaker().torus(1500);
  const FirstMesh found = first_mesh({points, {}});
  // Powers of two are exact; the box has its middle elsewhere.
  const FirstMesh scaled = first_mesh({points * 1024.0, {}});
  EXPECT_EQ(scaled.mesh.face_vertices, found.mesh.face_vertices);
  EXPECT_NEAR((scaled.mesh.points / 1024.0 - found.mesh.points).cwiseAbs().maxCoeff(), 0.0, 1e-12);
  const FirstMesh moved = first_mesh({(points * 1e9).rowwise() + Eigen::RowVector3d(1e12, -1e12, 3e11), {}});
  expect_closed(moved, 1);
}

TEST(FirstMesh, GivesPartsThatAreFarApartAGridEach) {
  CloudMaker maker;
  Points points(2400, 3);
  points << maker.sphere(800), maker.torus(800).rowwise() + Eigen::RowVector3d(1000.0, 0.0, 0.0),
      maker.sphere(800).rowwise() + Eigen::RowVector3d(1e7, 1e7, 0.0);
  const FirstMesh found = first_mesh({points, {}});
  expect_sound(found);
  ASSERT_EQ(found.parts.size(), 3U);
  EXPECT_EQ(found.genus(), 1);
  EXPECT_NEAR(found.mesh.vertex_count(), 400, 40);
}

TEST(FirstMesh, LeavesOutAFewPointsFarAway) {
  Points points(1003, 3);
  points.topRows(1000) = CloudMaker().sphere(1000);
  points.bottomRows(3) << 500.0, 0.0, 0.0, 500.0, 1.0, 0.0, -3e8, 0.0, 1.0;
  const FirstMesh found = first_mesh({points, {}});
  expect_closed(found, 0);
  EXPECT_EQ(found.outliers, 3);
}

TEST(FirstMesh, EndsWhereOpenSurfacesEnd) {
  CloudMaker maker;
  Points half = maker.sphere(2000);
  half.col(2) = half.col(2).cwiseAbs();
  Points sheet(1500, 3);
  Points tube(2500, 3);
  for (Index i = 0; i < 1500; ++i) sheet.row(i) << maker.uniform(), maker.uniform(), 0.0;
  for (Index i = 0; i < 2500; ++i) {
    const double angle = maker.uniform(0.0, 2.0 * std::numbers::pi);
    tube.row(i) << std::cos(angle), std::sin(angle), maker.uniform(0.0, 3.0);
  }
  for (const auto& [points, loops] : {std::pair<Points, Index>{half, 1}, {sheet, 1}, {tube, 2}}) {
    const FirstMesh found = first_mesh({points, {}});
    expect_sound(found);
    ASSERT_EQ(found.parts.size(), 1U);
    EXPECT_EQ(found.genus(), 0);
    EXPECT_EQ(found.parts[0].boundary_loops, loops);
    const Eigen::RowVector3d over = (found.mesh.points.colwise().maxCoeff() - points.colwise().maxCoeff()).cwiseAbs() +
                                    (found.mesh.points.colwise().minCoeff() - points.colwise().minCoeff()).cwiseAbs();
    EXPECT_LT(over.maxCoeff(), 0.15) << "ends elsewhere than the points";
  }
}

/// A sphere without a cap of half angle a has a hole of width 2 sin(a), here 0.68.
TEST(FirstMesh, ClosesHolesNarrowerThanTheBridge) {
  const Points all = CloudMaker().sphere(3000);
  Points points(all.rows(), 3);
  Index count = 0;
  for (Index i = 0; i < static_cast<Index>(all.rows()); ++i) {
    if (all(i, 2) < 0.94) points.row(count++) = all.row(i);
  }
  points.conservativeResize(count, 3);
  FirstMeshOptions options;
  options.bridge = 1.0;
  expect_closed(first_mesh({points, {}}, options), 0);
  options.bridge = 0.3;
  const FirstMesh open = first_mesh({points, {}}, options);
  expect_sound(open);
  EXPECT_EQ(open.parts[0].boundary_loops, 1);
}

TEST(FirstMesh, HasTheGenusAskedForOrSaysThatNoGridGivesIt) {
  FirstMeshOptions options;
  options.genus = 1;
  expect_closed(first_mesh({CloudMaker().torus(1500), {}}, options), 1);
  options.genus = 3;
  test::expect_error([&] { first_mesh({CloudMaker().sphere(1500), {}}, options); }, ErrorCode::NotConverged, "genus 3");
}

TEST(FirstMesh, LaysQuadsAlongAGrid) {
  FirstMeshOptions options;
  options.pattern = QuadPattern::Grid;
  const FirstMesh found = first_mesh({CloudMaker().torus(2000), {}}, options);
  expect_closed(found, 1);
  EXPECT_NEAR(found.mesh.vertex_count(), 400, 60);
  for (Index f = 0; f < found.mesh.face_count(); ++f) EXPECT_EQ(found.mesh.face_size(f), 4);
}

TEST(FirstMesh, HasQuadsOnlyOnClosedSurfaces) {
  const FirstMesh found = first_mesh({CloudMaker().double_torus(3000), {}});
  for (Index f = 0; f < found.mesh.face_count(); ++f) EXPECT_EQ(found.mesh.face_size(f), 4);
}

TEST(FirstMesh, RefusesCloudsThatAreNoSurface) {
  const auto refuse = [](const Points& points, ErrorCode code, const char* part) {
    test::expect_error([&] { first_mesh({points, {}}); }, code, part);
  };
  for (const Index count : {0, 1, 2, 3, 19}) refuse(CloudMaker().sphere(count), ErrorCode::BadArgument, "20 places");
  refuse(Points::Constant(100, 3, 0.1), ErrorCode::BadArgument, "20 places");
  Points line(100, 3);
  for (Index i = 0; i < 100; ++i) line.row(i) = 0.01 * i * Eigen::RowVector3d(1.0, 0.3, -2.0);
  refuse(line, ErrorCode::BadArgument, "on one line");
  Points gap = CloudMaker().sphere(100);
  gap(70, 1) = std::nan("");
  refuse(gap, ErrorCode::NotFinite, "point");
  gap(70, 1) = std::numeric_limits<double>::infinity();
  refuse(gap, ErrorCode::NotFinite, "point");
  const Points good = CloudMaker().sphere(100);
  test::expect_error([&] { first_mesh({good, Points::Zero(99, 3)}); }, ErrorCode::BadShape, "99 normals");
}

TEST(FirstMesh, RefusesOptionsOutOfRange) {
  const PointCloud cloud{CloudMaker().sphere(100), {}};
  const auto refuse = [&](const FirstMeshOptions& options, const char* part) {
    test::expect_error([&] { first_mesh(cloud, options); }, ErrorCode::BadArgument, part);
  };
  FirstMeshOptions options;
  for (const Index vertices : {-1, 0, 7, 1000001}) {
    options.vertices = vertices;
    refuse(options, "vertices");
  }
  options = {};
  options.genus = -1;
  refuse(options, "genus");
  options = {};
  options.bridge = -0.1;
  refuse(options, "bridge");
}

TEST(FirstMesh, StopsWhenAskedTo) {
  const PointCloud cloud{CloudMaker().sphere(2000), {}};
  int calls = 0;
  first_mesh(cloud, {}, [&](double) { return ++calls > 0; });
  ASSERT_GT(calls, 10);
  for (const int stop : {1, 3, calls / 2, calls - 1}) {
    int left = stop;
    EXPECT_EQ(test::code_of([&] { first_mesh(cloud, {}, [&](double) { return --left > 0; }); }), ErrorCode::Cancelled);
  }
}

struct RealCloud {
  const char* name;
  Index genus;
  double outliers;
};

/// Scanned and sampled shapes. The bunny's ears are thinner than planes through neighbours can tell apart.
TEST(FirstMesh, HasTheGenusOfRealShapes) {
  const std::string folder = test::cloud_folder();
  if (folder.empty()) GTEST_SKIP() << "BATTEN_DATA is not set";
  for (const RealCloud& real :
       {RealCloud{"bulb-1000", 0, 0.1}, RealCloud{"head-1779", 0, 0.1}, RealCloud{"fandisk-2031", 0, 0.1},
        RealCloud{"bunny-2000", 0, 0.0}, RealCloud{"cactus", 0, 0.1}, RealCloud{"rocker-arm-2000", 1, 0.1}}) {
    SCOPED_TRACE(real.name);
    const Points points = read_mesh(folder + real.name + ".xyz").points;
    expect_closed(first_mesh({CloudMaker().with_outliers(points, real.outliers), {}}), real.genus);
  }
}

TEST(FirstMesh, EndsWhereTheScanEnds) {
  const std::string folder = test::cloud_folder();
  if (folder.empty()) GTEST_SKIP() << "BATTEN_DATA is not set";
  FirstMeshOptions options;
  options.vertices = 1000;
  const FirstMesh found = first_mesh({read_mesh(folder + "distcap.xyz").points, {}}, options);
  expect_sound(found);
  ASSERT_EQ(found.parts.size(), 1U);
  EXPECT_EQ(found.parts[0].boundary_loops, 1);
}

/// 20,000 points with noise, 200 outliers and a hole of a quarter of the size.
TEST(FirstMesh, BridgesTheHoleOfANoisyHead) {
  const std::string folder = test::cloud_folder();
  if (folder.empty()) GTEST_SKIP() << "BATTEN_DATA is not set";
  const Points points = read_mesh(folder + "head-20000-noisy-hole.xyz").points;
  FirstMeshOptions options;
  options.bridge = 200.0;
  const FirstMesh found = first_mesh({points, {}}, options);
  expect_closed(found, 0);
  EXPECT_NEAR(found.outliers, 200, 60);
}

}  // namespace
}  // namespace batten
