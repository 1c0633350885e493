#include "batten/volume/segment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "batten/error.h"
#include "batten/volume/label_mask.h"
#include "batten/volume/segment_measures.h"
#include "batten/volume/slice.h"
#include "support/errors.h"
#include "volume/phantoms.h"

namespace batten {
namespace {

using std::numbers::pi;

Segmentation segmented(const Volume& volume, Index vertices = 120) {
  SegmentOptions options;
  options.vertices = vertices;
  return segment_mask(label_mask(volume, {}), options);
}

SurfaceMeasures measured(const Segmentation& found) {
  return measure_surface(found.topology, found.scheme, found.mesh);
}

TEST(SegmentMask, ABallIsRound) {
  constexpr double kRadius = 9.0;
  const Volume ball =
      test::made_volume(test::centred_grid(25), [](const Eigen::Vector3d& at) { return at.norm() < kRadius ? 1 : 0; });
  const Segmentation found = segmented(ball);
  const SurfaceMeasures measures = measured(found);
  EXPECT_EQ(found.genus, 0);
  EXPECT_EQ(found.components, 1);
  EXPECT_EQ(measures.self_intersections, 0);
  const Scalars radii = measures.fine.points.rowwise().norm();
  EXPECT_NEAR(radii.mean(), kRadius, 0.15);
  EXPECT_LT(radii.maxCoeff() - radii.minCoeff(), 1.0) << "smoother than the voxels' steps";
  EXPECT_NEAR(measures.area, 4.0 * pi * kRadius * kRadius, 0.04 * measures.area);
  const MaskAgreement agreement = compare_with_mask(measures.fine, label_mask(ball, {}));
  EXPECT_GT(agreement.dice, 0.98);
  EXPECT_NEAR(measures.volume, agreement.mask_volume, 0.02 * agreement.mask_volume);
}

TEST(SegmentMask, SaysThatAPartOfTwoVoxelsIsTooSmall) {
  const Volume two = test::made_volume(test::centred_grid(9), [](const Eigen::Vector3d& at) {
    return std::abs(at[1]) < 0.5 && std::abs(at[2]) < 0.5 && at[0] > -0.5 && at[0] < 1.5 ? 1 : 0;
  });
  test::expect_error([&] { segmented(two); }, ErrorCode::BadArgument, "only 10 outer faces");
}

TEST(SegmentMask, ALineAndAPlateOfOneVoxelAreWhole) {
  for (const double across : {0.5, 10.0}) {
    const Volume thin = test::made_volume(test::centred_grid(25), [&](const Eigen::Vector3d& at) {
      return std::abs(at[0]) < 10.0 && std::abs(at[1]) < across && std::abs(at[2]) < 0.5 ? 1 : 0;
    });
    const Segmentation found = segmented(thin, across < 1.0 ? 386 : 1500);
    EXPECT_EQ(found.components, 1) << across;
    EXPECT_EQ(found.genus, 0) << across;
    const SurfaceMeasures measures = measured(found);
    EXPECT_EQ(measures.self_intersections, 0);
    EXPECT_GT(compare_with_mask(measures.fine, label_mask(thin, {})).dice, 0.95);
  }
}

TEST(SegmentMask, TheWorldsSurfaceDoesNotDependOnTheOrderOfIndices) {
  const Volume shape = test::made_volume(test::centred_grid(27), test::bean);
  const Segmentation plain = segmented(shape, 80);
  const Segmentation turned = segmented(test::rearranged(shape, {2, 0, 1}, {true, false, true}), 80);
  ASSERT_EQ(plain.mesh.face_vertices, turned.mesh.face_vertices);
  EXPECT_LT((plain.mesh.points - turned.mesh.points).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(SegmentMask, AnObliqueAnisotropicVolumeGivesTheSameShape) {
  const Volume shape = test::made_volume(test::centred_grid(27), test::bean);
  VolumeGrid oblique = test::centred_grid(36);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.5, Eigen::Vector3d(3, 1, 2).normalized()).toRotationMatrix();
  oblique.axes = turn * Eigen::Vector3d(0.7, 0.8, 1.3).asDiagonal();
  oblique.origin = -oblique.axes * Eigen::Vector3d::Constant(17.5);
  const Segmentation plain = segmented(shape);
  const SurfaceMeasures other = measured(segmented(test::made_volume(oblique, test::bean)));
  const SurfaceMeasures measures = measured(plain);
  EXPECT_NEAR(other.volume, measures.volume, 0.03 * measures.volume);
  EXPECT_GT(compare_with_mask(other.fine, label_mask(shape, {})).dice, 0.95);
}

TEST(SegmentMask, FindsHandlesAndComponents) {
  const auto ring = [](const Eigen::Vector3d& at) {
    return std::hypot(at.head<2>().norm() - 9.0, at[2]) < 3.5 ? 1 : 0;
  };
  const Segmentation torus = segmented(test::made_volume(test::centred_grid(31), ring), 200);
  EXPECT_EQ(torus.genus, 1);
  EXPECT_EQ(torus.topology.vertex_count() - torus.topology.edge_count() + torus.topology.face_count(), 0);
  const auto balls = [](const Eigen::Vector3d& at) {
    return (at - Eigen::Vector3d(8, 0, 0)).norm() < 5.0 || (at + Eigen::Vector3d(8, 0, 0)).norm() < 5.0 ? 1 : 0;
  };
  EXPECT_EQ(segmented(test::made_volume(test::centred_grid(31), balls), 200).components, 2);
}

TEST(SegmentMask, AnObjectAtTheBorderOfTheVolumeIsClosed) {
  const auto dome = [](const Eigen::Vector3d& at) { return (at - Eigen::Vector3d(0, 0, 10)).norm() < 8.0 ? 1 : 0; };
  const Volume volume = test::made_volume(test::centred_grid(21), dome);
  const SurfaceMeasures measures = measured(segmented(volume));
  const MaskAgreement agreement = compare_with_mask(measures.fine, label_mask(volume, {}));
  EXPECT_GT(agreement.dice, 0.96);
  EXPECT_LT(measures.fine.points.col(2).maxCoeff(), 11.5) << "the outermost voxels end at 10.5";
}

TEST(SegmentMask, AThinPlateStaysWhole) {
  const auto plate = [](const Eigen::Vector3d& at) { return at[2] == 0.0 && at.head<2>().norm() < 9.0 ? 1 : 0; };
  const Segmentation found = segmented(test::made_volume(test::centred_grid(25), plate), 200);
  EXPECT_EQ(found.components, 1);
  EXPECT_EQ(measured(found).self_intersections, 0)
      << found.rounds << " rounds, cut " << found.cut_steps << " V " << found.mesh.vertex_count();
}

TEST(SegmentMask, SaysWhichLabelsThereAre) {
  const Volume labels =
      test::made_volume(test::centred_grid(5), [](const Eigen::Vector3d& at) { return at[0] > 0 ? 7 : 3; });
  test::expect_error([&] { label_mask(labels, {71}); }, ErrorCode::BadArgument, "3, 7");
  SegmentOptions options;
  options.smoothing = -1.0;
  test::expect_error([&] { segment_mask(label_mask(labels, {7}), options); }, ErrorCode::BadArgument, "smoothing");
}

TEST(Slices, CutTheSurfaceWhereItIs) {
  const Volume ball =
      test::made_volume(test::centred_grid(25), [](const Eigen::Vector3d& at) { return at.norm() < 8.0 ? 1 : 0; });
  const SurfaceMeasures measures = measured(segmented(ball));
  const std::vector<VolumeSlice> slices = slices_through(ball, measures.fine, 1);
  ASSERT_EQ(slices.size(), 3U);
  for (const VolumeSlice& slice : slices) {
    ASSERT_FALSE(slice.lines.empty());
    double length = 0.0;
    for (const auto& line : slice.lines) length += std::hypot(line[2] - line[0], line[3] - line[1]);
    EXPECT_NEAR(length, 2.0 * pi * 8.0, 1.5) << slice.caption << ": a circle";
  }
  EXPECT_EQ(slices[2].caption.substr(0, 5), "axial");
}

}  // namespace
}  // namespace batten
