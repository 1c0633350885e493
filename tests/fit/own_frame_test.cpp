#include "batten/fit/own_frame.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "batten/fit/fit_surface.h"
#include "batten/io/io.h"
#include "fit/clouds.h"

namespace batten {
namespace {

using test::CloudMaker;

/// Turned, scaled and moved, all by numbers that binary fractions do not hold.
struct Motion {
  Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()).matrix();
  double scale = 37.3;
  Eigen::RowVector3d way{11.1, -5.3, 2.9};

  Points of(const Points& points) const { return ((scale * points) * turn.transpose()).rowwise() + way; }
};

Points stretched_sphere(Index count) {
  return CloudMaker(2).sphere(count) * Eigen::Vector3d(3.0, 2.0, 1.0).asDiagonal();
}

TEST(OwnFrame, IsRightHandedAndGoesBack) {
  const Points points = stretched_sphere(300);
  const OwnFrame frame = own_frame(points);
  EXPECT_NEAR(frame.axes.determinant(), 1.0, 1e-14);
  EXPECT_LT((frame.back(frame.into(points)) - points).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_NEAR(frame.into(points).rowwise().norm().maxCoeff(), 1.0, 1e-15);
  EXPECT_LT(frame.into(points).colwise().mean().norm(), 1e-15);
}

TEST(OwnFrame, DoesNotDependOnTheOrderOfPoints) {
  const Points points = stretched_sphere(300);
  const OwnFrame one = own_frame(points);
  const OwnFrame other = own_frame(CloudMaker(7).shuffled(points));
  EXPECT_EQ(one.centre, other.centre);
  EXPECT_EQ(one.axes, other.axes);
  EXPECT_EQ(one.size, other.size);
}

TEST(OwnFrame, ShowsMovedPointsTheSameToTheBit) {
  const Points points = stretched_sphere(300);
  const Points moved = Motion().of(points);
  Points here = own_frame(points).into(points);
  Points there = own_frame(moved).into(moved);
  EXPECT_NE(here, there) << "rounding differs";
  EXPECT_LT((here - there).cwiseAbs().maxCoeff(), 1e-14);
  drop_rounding(here);
  drop_rounding(there);
  EXPECT_EQ(here, there);
}

/// A plane, a line and a single place have frames, too.
TEST(OwnFrame, OfFlatCloudsIsFinite) {
  Points flat = stretched_sphere(50);
  flat.col(1).setZero();
  EXPECT_NEAR(own_frame(flat).into(flat).col(2).cwiseAbs().maxCoeff(), 0.0, 1e-15);
  flat.col(2).setZero();
  const OwnFrame line = own_frame(flat);
  EXPECT_NEAR(line.axes.determinant(), 1.0, 1e-14);
  EXPECT_NEAR(line.into(flat).rightCols(2).cwiseAbs().maxCoeff(), 0.0, 1e-15);
}

/// From nothing but points: first mesh, creases and rounds.
void expect_the_same_moved(const Points& points, const FitOptions& options) {
  const Motion motion;
  const FitResult here = fit_surface({points, Points(0, 3)}, options);
  const FitResult there = fit_surface({motion.of(points), Points(0, 3)}, options);
  ASSERT_EQ(here.mesh.face_vertices, there.mesh.face_vertices);
  EXPECT_EQ(here.mesh.creases.size(), there.mesh.creases.size());
  EXPECT_LT((motion.of(here.mesh.points) - there.mesh.points).cwiseAbs().maxCoeff(), 1e-9 * there.report.diameter);
  EXPECT_NEAR(motion.scale * here.report.to_surface.max, there.report.to_surface.max, 1e-9 * there.report.diameter);
  EXPECT_NEAR(motion.scale * here.report.spacing, there.report.spacing, 1e-9 * there.report.diameter);
  ASSERT_EQ(here.report.rounds.size(), there.report.rounds.size());
  EXPECT_NEAR(motion.scale * here.report.rounds.back().rms, there.report.rounds.back().rms,
              1e-9 * there.report.diameter);
}

TEST(FitSurface, FollowsMotionAndScaleFromPointsAlone) {
  FitOptions options;
  options.vertices = 60;
  for (const SchemeKind kind : {SchemeKind::CatmullClark, SchemeKind::Loop}) {
    options.scheme.kind = kind;
    expect_the_same_moved(CloudMaker(3).torus(400), options);
  }
}

TEST(FitSurface, FollowsMotionAndScaleOfAScan) {
  if (test::cloud_folder().empty()) GTEST_SKIP() << "set BATTEN_DATA to the folder of test data";
  FitOptions options;
  options.vertices = 150;
  options.rounds = 10;
  expect_the_same_moved(read_mesh(test::cloud_folder() + "bulb-1000.xyz").points, options);
}

}  // namespace
}  // namespace batten
