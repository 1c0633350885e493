#include "batten/fit/fit_surface.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "batten/fit/followed_cloud.h"
#include "batten/fit/surface_fitter.h"
#include "batten/io/io.h"
#include "batten/mesh/primitives.h"
#include "batten/mesh/self_intersections.h"
#include "batten/nearest/surface_distances.h"
#include "batten/refine/refinement.h"
#include "batten/surface/limit_surface.h"
#include "batten/tessellate/surface_mesh.h"
#include "fit/clouds.h"
#include "support/errors.h"
#include "support/shapes.h"

namespace batten {
namespace {

using test::CloudMaker;

/// Places spread over the faces of a mesh's own surface, `side` by `side` a face.
PointCloud exact_samples(const Mesh& mesh, const Scheme& scheme, int side) {
  const LimitSurface surface(Topology(mesh), scheme, mesh.points);
  const Index faces = surface.base().face_count();
  PointCloud cloud;
  cloud.points.resize(faces * side * side, 3);
  cloud.normals.resize(cloud.points.rows(), 3);
  Index row = 0;
  for (Index f = 0; f < faces; ++f) {
    for (int i = 0; i < side * side; ++i, ++row) {
      const Jet jet = surface.jet({f, (i % side + 0.5) / side, (i / side + 0.5) / side});
      cloud.points.row(row) = jet.point.transpose();
      cloud.normals.row(row) = jet.du.cross(jet.dv).normalized().transpose();
    }
  }
  return cloud;
}

FitOptions quick(Index vertices) {
  FitOptions options;
  options.vertices = vertices;
  return options;
}

/// The greatest distance of a fine mesh of the surface's points from the unit sphere.
double off_sphere(const FitResult& fit) {
  const Mesh fine = surface_mesh(fit.topology, fit.scheme, fit.mesh, 3);
  return (fine.points.rowwise().norm().array() - 1.0).abs().maxCoeff();
}

/// Exact samples leave nothing to trade against: fairness falls with the square of what is left.
TEST(FitSurface, FindsAKnownSurfaceAgainFromItsMovedMesh) {
  const Mesh known = torus(10, 6);
  FitOptions options;
  options.initial = test::jittered(known, 0.02, 3);
  options.rounds = 60;
  const FitResult fit = fit_surface(exact_samples(known, Scheme(), 4), options);
  EXPECT_LT(fit.report.to_surface.max, 1e-6 * fit.report.diameter);
  EXPECT_EQ(fit.mesh.face_vertices, known.face_vertices) << "the initial mesh keeps its faces and their order";
}

TEST(FitSurface, FindsACreasedSurfaceAgainFromItsMovedMesh) {
  Mesh known = torus(10, 6);
  for (Index i = 0; i < 10; ++i) known.creases.push_back({6 * i, 6 * ((i + 1) % 10), kInfiniteSharpness});
  FitOptions options;
  options.initial = test::jittered(known, 0.02, 3);
  options.rounds = 60;
  const FitResult fit = fit_surface(exact_samples(known, Scheme(), 4), options);
  EXPECT_LT(fit.report.to_surface.max, 1e-6 * fit.report.diameter);
  EXPECT_EQ(fit.mesh.creases.size(), known.creases.size());
}

/// Samples lie inside the faces: how far the surface goes on beyond the outermost ones is open, and it creeps there.
TEST(FitSurface, FindsASurfaceWithABoundaryAgainFromItsMovedMesh) {
  Mesh known = grid(7, 7);
  for (Index v = 0; v < known.vertex_count(); ++v)
    known.points(v, 2) = 0.3 * std::sin(known.points(v, 0)) * std::cos(2.0 * known.points(v, 1));
  FitOptions options;
  options.initial = test::jittered(known, 0.02, 3);
  options.rounds = 60;
  const FitResult fit = fit_surface(exact_samples(known, Scheme(), 6), options);
  EXPECT_LT(fit.report.to_surface.rms, 1e-6 * fit.report.diameter);
  EXPECT_LT(fit.report.to_surface.max, 2e-6 * fit.report.diameter);
}

TEST(FitSurface, FitsASphereOfPoints) {
  PointCloud cloud;
  cloud.points = CloudMaker().sphere(1500);
  FitOptions options = quick(100);
  options.start = FitStart::Sphere;
  const FitResult fit = fit_surface(cloud, options);
  EXPECT_EQ(fit.topology.vertex_count(), 98);
  EXPECT_LT(off_sphere(fit), 2e-3);
  EXPECT_NEAR(fit.report.diameter, 2.0, 1e-2) << "random points leave gaps";
}

TEST(FitSurface, FindsTheHandleOfATorus) {
  for (const SchemeKind kind : {SchemeKind::CatmullClark, SchemeKind::Loop}) {
    FitOptions options = quick(150);
    options.scheme.kind = kind;
    const FitResult fit = fit_surface({CloudMaker().torus(1500), Points(0, 3)}, options);
    const Topology& made = fit.topology;
    EXPECT_EQ(made.vertex_count() - made.edge_count() + made.face_count(), 0);
    EXPECT_LE(made.vertex_count(), 150);
    EXPECT_LT(fit.report.to_surface.rms, 2e-3 * fit.report.diameter);
  }
}

TEST(FitSurface, ReportsDistancesOfTheSurfaceThatItReturns) {
  const PointCloud cloud{CloudMaker().torus(800), Points(0, 3)};
  const FitResult fit = fit_surface(cloud, quick(100));
  const Mesh fine = surface_mesh(fit.topology, fit.scheme, fit.mesh, 5);
  double greatest = 0.0;
  for (Eigen::Index i = 0; i < cloud.points.rows(); ++i) {
    const double brute = std::sqrt((fine.points.rowwise() - cloud.points.row(i)).rowwise().squaredNorm().minCoeff());
    EXPECT_LE(fit.distances[i], brute + 1e-12) << "vertices of a tessellation are on the surface";
    greatest = std::max(greatest, brute);
  }
  EXPECT_NEAR(fit.report.to_surface.max, greatest, 0.015) << "half the diagonal of the tessellation's faces";
}

TEST(FitSurface, NeverRaisesTheObjectiveWithinARound) {
  const FitResult fit = fit_surface({CloudMaker().torus(800), Points(0, 3)}, quick(100));
  ASSERT_FALSE(fit.report.rounds.empty());
  for (const FitRound& round : fit.report.rounds) EXPECT_LE(round.after, round.objective * (1.0 + 1e-12));
}

TEST(FitSurface, DoesNotDependOnTheOrderOfPoints) {
  const Points points = CloudMaker().torus(600);
  const FitResult one = fit_surface({points, Points(0, 3)}, quick(100));
  const FitResult other = fit_surface({CloudMaker(7).shuffled(points), Points(0, 3)}, quick(100));
  EXPECT_EQ(one.mesh.points, other.mesh.points);
  EXPECT_EQ(one.mesh.face_vertices, other.mesh.face_vertices);
  EXPECT_EQ(one.report.to_surface.max, other.report.to_surface.max);
}

/// Row i of the distances is point i's, in whatever order the fit works.
TEST(FitSurface, ReportsDistancesInTheOrderOfThePoints) {
  const Points points = CloudMaker(9).shuffled(CloudMaker().torus(500));
  const FitResult fit = fit_surface({points, Points(0, 3)}, quick(100));
  const SurfaceDistances measured = measure_distances(fit.topology, fit.scheme, fit.mesh.points, points);
  EXPECT_LT((fit.distances - measured.distances.cwiseAbs()).cwiseAbs().maxCoeff(), 1e-9);
}

/// Turned, moved and 1000 times as large: the same surface so. A start of one's own keeps grids out of it.
TEST(FitSurface, FollowsMotionAndScale) {
  const Mesh known = torus(8, 5);
  const PointCloud cloud = exact_samples(known, Scheme(), 3);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()).matrix();
  const auto moved = [&](const Points& points) -> Points {
    return ((1000.0 * points * turn.transpose()).rowwise() + Eigen::RowVector3d(30.0, -20.0, 10.0));
  };
  FitOptions options;
  options.initial = test::jittered(known, 0.05, 3);
  options.rounds = 6;
  const FitResult one = fit_surface(cloud, options);
  options.initial->points = moved(options.initial->points);
  const FitResult other = fit_surface({moved(cloud.points), cloud.normals * turn.transpose()}, options);
  EXPECT_LT((moved(one.mesh.points) - other.mesh.points).cwiseAbs().maxCoeff(), 1e-8 * other.report.diameter)
      << "conjugate gradients stop at other roundings";
}

/// Every point stands three times in the cloud.
TEST(FitSurface, TakesRepeatedPointsOnce) {
  const Points points = CloudMaker().torus(500);
  const Points repeated = points.replicate(3, 1);
  const FitResult one = fit_surface({points, Points(0, 3)}, quick(100));
  const FitResult three = fit_surface({repeated, Points(0, 3)}, quick(100));
  EXPECT_EQ(one.mesh.points, three.mesh.points);
  EXPECT_EQ(one.report.spacing, three.report.spacing);
  EXPECT_EQ(three.distances.size(), 1500);
  EXPECT_NEAR(one.report.to_surface.rms, three.report.to_surface.rms, 1e-9);
}

double rms_of_first(const FitResult& fit, Index count) {
  return fit.distances.head(count).norm() / std::sqrt(static_cast<double>(count));
}

/// The points of a sphere and one in ten anywhere in its box: the others are found as exactly as without, within what
/// the chance of control points makes.
TEST(FitSurface, DoesNotFollowOutliers) {
  const Points clean = CloudMaker().sphere(1500);
  FitOptions options = quick(100);
  options.start = FitStart::Sphere;
  const double without = rms_of_first(fit_surface({clean, Points(0, 3)}, options), 1500);
  for (const SchemeKind kind : {SchemeKind::CatmullClark, SchemeKind::Loop}) {
    options.scheme.kind = kind;
    options.start = kind == SchemeKind::Loop ? FitStart::Auto : FitStart::Sphere;
    const FitResult fit = fit_surface({CloudMaker(5).with_outliers(clean, 0.1), Points(0, 3)}, options);
    EXPECT_GE(fit.report.outliers, 145) << "of 150, one in four of which is nearer than a point's neighbours";
    EXPECT_LE(fit.report.outliers, 152);
    EXPECT_LT(rms_of_first(fit, 1500), (kind == SchemeKind::Loop ? 4.0 : 1.5) * without);
    EXPECT_EQ(fit.report.unsound, 0);
  }
}

/// Outliers that are named by the flags of the first rounds stay out of the normals and of the first mesh.
TEST(FollowedCloud, HasNormalsWithoutOutliers) {
  const Points clean = CloudMaker().sphere(400);
  const Points all = CloudMaker(3).with_outliers(clean, 0.2);
  Buffer<std::uint8_t> outliers(480, 0);
  std::fill(outliers.begin() + 400, outliers.end(), std::uint8_t{1});
  const FollowedCloud cloud({all, Points(0, 3)}, outliers);
  EXPECT_EQ(cloud.followed().points, clean);
  EXPECT_EQ(cloud.followed().normals, estimate_normals(clean));
  EXPECT_EQ(cloud.all().points, all);
  EXPECT_EQ(cloud.all().normals.topRows(400), cloud.followed().normals);
  const FollowedCloud whole({clean, Points(0, 3)}, Buffer<std::uint8_t>(400, 0));
  EXPECT_EQ(whole.followed().points, clean);
  EXPECT_EQ(whole.all().normals, whole.followed().normals);
}

/// Counted again on a finer tessellation than the fit looks at.
TEST(FitSurface, NeitherFoldsNorPassesThroughItself) {
  if (test::cloud_folder().empty()) GTEST_SKIP() << "set BATTEN_DATA to the folder of test data";
  for (const char* const name : {"head-1779", "bunny-2000", "rocker-arm-2000"}) {
    const Mesh points = read_mesh(test::cloud_folder() + name + ".xyz");
    const FitResult fit = fit_surface({points.points, Points(0, 3)}, quick(386));
    EXPECT_EQ(fit.report.unsound, 0) << name;
    const Mesh fine = surface_mesh(fit.topology, fit.scheme, fit.mesh, 3);
    EXPECT_EQ(find_self_intersections(Topology(fine), fine.points).count, 0) << name;
    EXPECT_LT(fit.report.to_surface.max, 0.012 * fit.report.diameter) << name;
  }
}

/// A control point shall go across two others along the tube.
TEST(SurfaceFitter, HoldsPointsBeforeFacesFold) {
  const Mesh start = torus(12, 8);
  PointCloud cloud{CloudMaker().torus(300), Points(0, 3)};
  cloud.normals = estimate_normals(cloud.points);
  SurfaceFitter fitter(Topology(start), Scheme(), start.points, cloud);
  EXPECT_FALSE(fitter.relax()) << "nothing is held";
  Values step = Values::Zero(start.points.rows(), 3);
  step.row(20) = 2.0 * (start.points.row(22) - start.points.row(20));
  const Values moved = fitter.stepped(start.points, step);
  EXPECT_LT((moved - start.points).row(20).norm(), 0.6 * step.row(20).norm());
  EXPECT_EQ(fitter.control(), start.points) << "the surface does not move";
  fitter.move_to(moved);
  EXPECT_EQ(fitter.unsound_faces(), 0);
  EXPECT_TRUE(fitter.relax());
  EXPECT_EQ(fitter.unsound_faces(), 0);
  fitter.move_to(start.points + step);
  EXPECT_GT(fitter.unsound_faces(), 0);
}

TEST(FitSurface, StopsAtTheTolerance) {
  FitOptions options = quick(2000);
  options.start = FitStart::Sphere;
  options.tolerance = 0.05;
  const FitResult fit = fit_surface({CloudMaker().sphere(500), Points(0, 3)}, options);
  EXPECT_EQ(fit.report.end, FitEnd::Tolerance);
  EXPECT_LE(fit.report.to_surface.max, 0.05);
  EXPECT_EQ(fit.topology.vertex_count(), 98) << "more control points were not needed";
}

TEST(FitSurface, RefusesCloudsThatNoSurfaceFits) {
  const auto fit = [](const Points& points) { fit_surface({points, Points(0, 3)}); };
  for (const Index count : {0, 1, 3})
    test::expect_error([&] { fit(CloudMaker().sphere(count)); }, ErrorCode::BadArgument, "four points");
  test::expect_error([&] { fit(Points::Ones(50, 3)); }, ErrorCode::BadArgument, "same place");
  Points line = Points::Zero(50, 3);
  for (Index i = 0; i < 50; ++i) line.row(i) = i * Eigen::RowVector3d(1.0, 2.0, 3.0);
  test::expect_error([&] { fit(line); }, ErrorCode::BadArgument, "line");
  Points hurt = CloudMaker().sphere(50);
  hurt(17, 1) = std::numeric_limits<double>::quiet_NaN();
  test::expect_error([&] { fit(hurt); }, ErrorCode::NotFinite, "17");
  FitOptions butterfly;
  butterfly.scheme.kind = SchemeKind::Butterfly;
  test::expect_error(
      [&] {
        fit_surface({CloudMaker().sphere(50), Points(0, 3)}, butterfly);
      },
      ErrorCode::BadArgument, "Butterfly");
}

/// Two control meshes, one after the other, each of which has rounds of several kinds.
TEST(FitSurface, ReportsProgressThatNeverFalls) {
  FitOptions options = quick(386);
  options.start = FitStart::Sphere;
  double last = 0.0;
  const FitResult fit = fit_surface({CloudMaker().torus(500, 1.0, 0.7), Points(0, 3)}, options, [&](double share) {
    EXPECT_GE(share, last - 1e-12);
    last = share;
    return true;
  });
  EXPECT_EQ(fit.topology.vertex_count(), 386);
  EXPECT_GT(last, 0.8);
}

/// Cancelled at every moment: nothing before the first round, and a whole surface from then on.
void expect_surfaces_kept(const Points& points, const FitOptions& options, int step) {
  bool kept = false;
  bool ended = false;
  for (int most = 0; !ended; most += step) {
    int calls = 0;
    try {
      const FitResult fit = fit_surface({points, Points(0, 3)}, options, [&](double) { return ++calls <= most; });
      kept = true;
      ended = fit.report.end != FitEnd::Cancelled;
      EXPECT_FALSE(fit.report.rounds.empty());
      EXPECT_TRUE(fit.mesh.points.allFinite());
      EXPECT_EQ(fit.scheme.kind, options.scheme.kind);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::Cancelled);
      EXPECT_FALSE(kept) << "there was a surface after fewer calls than " << most;
    }
  }
}

TEST(FitSurface, KeepsTheLastWholeRoundWhenCancelled) {
  FitOptions options = quick(100);
  options.start = FitStart::Sphere;
  expect_surfaces_kept(CloudMaker().sphere(300), options, 17);
}

/// Between rounds that look for outliers and those of the fit, too.
TEST(FitSurface, KeepsASurfaceWhileItLooksForOutliers) {
  FitOptions options = quick(60);
  options.scheme.kind = SchemeKind::Loop;
  options.rounds = 4;
  expect_surfaces_kept(CloudMaker(5).with_outliers(CloudMaker().sphere(400), 0.1), options, 17);
}

/// The points of a box begin a fit with creases and one without.
TEST(FitSurface, KeepsASurfaceBetweenItsTwoBeginnings) {
  CloudMaker maker(4);
  Points box(600, 3);
  for (Index i = 0; i < 600; ++i) {
    for (Index c = 0; c < 3; ++c) box(i, c) = maker.uniform(-1.0, 1.0);
    box(i, i % 3) = i % 2 == 0 ? 1.0 : -1.0;
  }
  FitOptions options = quick(60);
  options.rounds = 4;
  ASSERT_FALSE(fit_surface({box, Points(0, 3)}, options).mesh.creases.empty()) << "both beginnings are made";
  expect_surfaces_kept(box, options, 17);
}

}  // namespace
}  // namespace batten
