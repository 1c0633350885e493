#include "batten/volume/segment_together.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "batten/mesh/joined_mesh.h"
#include "batten/mesh/primitives.h"
#include "batten/mesh/triangulate.h"
#include "batten/parallel/threads.h"
#include "batten/volume/inside_volume.h"
#include "support/errors.h"
#include "volume/phantoms.h"

namespace batten {
namespace {

constexpr double kRadius = 10.0;

/// A ball that two planes cut into quarters, labels 1 to 4; the walls are at -0.5.
double quarter(const Eigen::Vector3d& at) {
  if (at.norm() >= kRadius) return 0.0;
  return 1.0 + (at[0] < -0.25 ? 0.0 : 1.0) + (at[1] < -0.25 ? 0.0 : 2.0);
}

double half(const Eigen::Vector3d& at) { return at.norm() >= kRadius ? 0.0 : at[0] < -0.25 ? 1.0 : 2.0; }

TogetherResult together(const Volume& image, std::vector<double> labels, Index vertices) {
  SegmentRequest request;
  request.label = std::move(labels);
  request.surface.vertices = vertices;
  return segment_together(image, request);
}

/// The limit surfaces as triangles, another number of them than segment_together() looks at.
std::vector<Mesh> other_meshes(const TogetherResult& result) {
  std::vector<Mesh> meshes;
  for (const SegmentResult& found : result.surfaces)
    meshes.push_back(triangulated(
        surface_of_faces(found.surface.topology, found.surface.scheme, found.surface.mesh, kMeasuredFaces / 8)));
  return meshes;
}

/// How often voxels are inside at most, by the winding of all surfaces: where two overlap it is more than once.
float most_inside(const TogetherResult& result, const VolumeGrid& grid) {
  std::vector<Mesh> meshes;
  for (const SegmentResult& found : result.surfaces) meshes.push_back(found.measures.fine);
  const Volume parts = inside_volume(joined_mesh(meshes), grid, VoxelRule::Part);
  return *std::max_element(parts.values.begin(), parts.values.end());
}

TEST(FindMeetings, CountsPairsOfTwoMeshesAlone) {
  const Mesh ball = triangulated(torus(16, 8));
  Mesh beside = ball;
  beside.points.col(2).array() += 10.0;
  EXPECT_TRUE(find_meetings({ball, beside}).empty());
  beside.points.col(2).array() -= 9.9;
  const std::vector<SurfaceMeeting> meetings = find_meetings({ball, beside});
  ASSERT_FALSE(meetings.empty());
  for (const SurfaceMeeting& meeting : meetings) {
    EXPECT_EQ(meeting.first, 0U);
    EXPECT_EQ(meeting.second, 1U);
  }
  Mesh folded = joined_mesh(std::vector<Mesh>{ball, beside});
  Mesh far = ball;
  far.points.col(0).array() += 100.0;
  EXPECT_TRUE(find_meetings({folded, far}).empty()) << "a mesh that meets itself does not meet another";
}

TEST(SegmentTogether, HalvesOfABallShareTheirWall) {
  const VolumeGrid grid = test::centred_grid(25);
  const TogetherResult result = together(test::made_volume(grid, half), {1, 2}, 120);
  ASSERT_EQ(result.surfaces.size(), 2U);
  EXPECT_GT(result.first_meetings, 0) << "alone they meet: the test says something";
  EXPECT_TRUE(find_meetings({result.surfaces[0].measures.fine, result.surfaces[1].measures.fine}).empty());
  EXPECT_TRUE(find_meetings(other_meshes(result)).empty());
  EXPECT_LT(most_inside(result, grid), 1.0 + 1e-5);
  double volume = 0.0;
  for (const SegmentResult& found : result.surfaces) {
    volume += found.measures.volume;
    EXPECT_EQ(found.measures.self_intersections, 0);
    EXPECT_GT(found.agreement->dice, 0.95);
    double sum = 0.0;
    int count = 0;
    for (const auto& row : found.measures.fine.points.rowwise()) {
      if (std::hypot(row[1], row[2]) > 6.0 || std::abs(row[0] + 0.5) > 3.0) continue;
      sum += std::abs(row[0] + 0.5);
      ++count;
    }
    ASSERT_GT(count, 100);
    EXPECT_LT(sum / count, 0.3) << "voxels from the wall";
  }
  EXPECT_NEAR(volume, 4.0 / 3.0 * std::numbers::pi * std::pow(kRadius, 3.0), 0.03 * volume);
  EXPECT_LT(result.most_withdrawn, 1.0);
}

TEST(SegmentTogether, HasTheSameBitsForAnyNumberOfThreads) {
  const Volume image = test::made_volume(test::centred_grid(25), half);
  const auto with = [&](int threads) {
    const ThreadLimit limit(threads);
    return together(image, {1, 2}, 40);
  };
  const TogetherResult one = with(1);
  const TogetherResult two = with(2);
  EXPECT_EQ(one.rounds, two.rounds);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(one.surfaces[i].surface.mesh.points, two.surfaces[i].surface.mesh.points);
}

TEST(SegmentTogether, FourQuartersMeetNowhere) {
  const VolumeGrid grid = test::centred_grid(25);
  const TogetherResult result = together(test::made_volume(grid, quarter), {1, 2, 3, 4}, 100);
  std::vector<Mesh> fine;
  for (const SegmentResult& found : result.surfaces) fine.push_back(found.measures.fine);
  EXPECT_TRUE(find_meetings(fine).empty());
  EXPECT_LT(most_inside(result, grid), 1.0 + 1e-5);
  for (const SegmentResult& found : result.surfaces) EXPECT_GT(found.agreement->dice, 0.93);
}

TEST(SegmentTogether, LabelsThatDoNotTouchAreTheirSurfacesAlone) {
  const auto balls = [](const Eigen::Vector3d& at) {
    return (at - Eigen::Vector3d(8, 0, 0)).norm() < 5.0   ? 1.0
           : (at + Eigen::Vector3d(8, 0, 0)).norm() < 6.0 ? 2.0
                                                          : 0.0;
  };
  const Volume image = test::made_volume(test::centred_grid(31), balls);
  const TogetherResult result = together(image, {2, 1}, 100);
  EXPECT_EQ(result.rounds, 0);
  SegmentRequest alone;
  alone.surface.vertices = 100;
  alone.label = {2};
  EXPECT_EQ(result.surfaces[0].surface.mesh.points, segment_volume(image, alone).surface.mesh.points);
}

TEST(SegmentTogether, RefusesWhatItDoesNotDo) {
  const Volume image = test::made_volume(test::centred_grid(25), half);
  test::expect_error([&] { together(image, {1}, 100); }, ErrorCode::BadArgument, "two labels or more");
  test::expect_error([&] { together(image, {1, 1}, 100); }, ErrorCode::BadArgument, "twice");
  test::expect_error([&] { together(image, {1, 7}, 100); }, ErrorCode::BadArgument, "no voxel has the label");
  SegmentRequest request;
  request.label = {1, 2};
  request.seed = Eigen::Vector3d(1, 2, 3);
  test::expect_error([&] { segment_together(image, request); }, ErrorCode::BadArgument, "labels alone");
  request.seed.reset();
  request.surface.vertices = 100;
  test::expect_error([&] { segment_together(image, request, [](double done) { return done < 0.3; }); },
                     ErrorCode::Cancelled, "");
}

}  // namespace
}  // namespace batten
