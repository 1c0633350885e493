#include "batten/volume/guarded_steps.h"

#include <gtest/gtest.h>

#include "batten/mesh/primitives.h"
#include "batten/mesh/self_intersections.h"
#include "batten/volume/segment_measures.h"

namespace batten {
namespace {

std::int64_t meetings(const SurfaceFitter& fitter) {
  const Mesh control = frame_mesh({fitter.topology(), fitter.scheme(), fitter.control()});
  const Mesh fine = surface_of_faces(fitter.topology(), fitter.scheme(), control, kMeasuredFaces);
  return find_self_intersections(Topology(fine), fine.points).count;
}

TEST(GuardedSteps, MendTheSurfaceWhereItMeetsItselfAndNowhereElse) {
  const Mesh body = torus(24, 10);
  Points control = body.points;
  // One control point goes through the tube's other side.
  control.row(0) += 1.6 * (Eigen::RowVector3d(body.points.colwise().mean()) - control.row(0));
  SurfaceFitter fitter(Topology(body), {}, control, {body.points, Points::Zero(body.points.rows(), 3)});
  GuardedSteps steps(fitter);
  ASSERT_GT(meetings(fitter), 0);
  steps.mend();
  EXPECT_EQ(meetings(fitter), 0);
  int moved = 0;
  for (Index vertex = 0; vertex < body.points.rows(); ++vertex)
    moved += fitter.control().row(vertex) == control.row(vertex) ? 0 : 1;
  EXPECT_GT(moved, 0);
  EXPECT_LT(moved, body.points.rows() / 2);
}

TEST(GuardedSteps, MendLeavesAWholeSurfaceAsItIs) {
  const Mesh body = torus(24, 10);
  SurfaceFitter fitter(Topology(body), {}, body.points, {body.points, Points::Zero(body.points.rows(), 3)});
  GuardedSteps(fitter).mend();
  EXPECT_EQ(fitter.control(), Values(body.points));
}

}  // namespace
}  // namespace batten
