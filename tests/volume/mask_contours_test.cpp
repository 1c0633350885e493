/// The border of a mask in some of its slices.
#include "batten/volume/mask_contours.h"

#include <gtest/gtest.h>

#include <cmath>

#include "batten/error.h"
#include "batten/volume/label_mask.h"
#include "batten/volume/segment_volume.h"
#include "support/errors.h"
#include "volume/phantoms.h"

namespace batten {
namespace {

Volume ball_mask() {
  return label_mask(
      test::made_volume(test::centred_grid(21), [](const Eigen::Vector3d& at) { return at.norm() < 6.5 ? 1.0 : 0.0; }),
      {});
}

TEST(MaskContours, LieInEveryNthSliceFromTheFirstOneOn) {
  const MaskContours found = mask_contours(ball_mask(), 4, 1);
  EXPECT_EQ(found.axis, 2);
  EXPECT_FALSE(found.painted);
  ASSERT_GT(found.points.rows(), 20);
  for (Eigen::Index row = 0; row < found.points.rows(); ++row) {
    const double z = found.points(row, 2);
    EXPECT_TRUE(z == -5.0 || z == -1.0 || z == 3.0) << z << ": the first of the ball's slices is -6";
    EXPECT_NEAR(found.points.row(row).norm(), 6.5, 1.0);
  }
}

TEST(MaskContours, OfALabelThatIsPaintedInSlicesAreTheseSlices) {
  for (const int axis : {0, 1, 2}) {
    Volume mask = ball_mask();
    for (std::ptrdiff_t voxel = 0; voxel < mask.grid.count(); ++voxel) {
      const Index at[] = {static_cast<Index>(voxel % mask.grid.size[0]),
                          static_cast<Index>(voxel / mask.grid.size[0] % mask.grid.size[1]),
                          static_cast<Index>(voxel / mask.grid.size[0] / mask.grid.size[1])};
      if (at[axis] % 3 != 0) mask.values[voxel] = 0.0F;
    }
    const MaskContours all = mask_contours(mask);
    EXPECT_TRUE(all.painted);
    EXPECT_EQ(all.axis, axis);
    const MaskContours every_second = mask_contours(mask, 2);
    EXPECT_LT(every_second.points.rows(), all.points.rows());
    const double step = std::abs(every_second.points(0, axis) - every_second.points.bottomRows(1)(0, axis));
    EXPECT_NEAR(std::remainder(step, 6.0), 0.0, 1e-9);
  }
}

TEST(MaskContours, AreThePointsOfARequestAndPaintedLabelsAreNotComparedWith) {
  SegmentRequest request;
  request.labels = ball_mask();
  request.label = {1.0};
  take_contours(request, 4);
  EXPECT_EQ(request.points, mask_contours(ball_mask(), 4).points);
  EXPECT_TRUE(request.labels) << "a whole label is compared with";
  for (std::ptrdiff_t voxel = 0; voxel < request.labels->grid.count(); ++voxel) {
    if (voxel / (21 * 21) % 3 != 0) request.labels->values[voxel] = 0.0F;
  }
  take_contours(request, 1);
  EXPECT_GT(request.points.rows(), 20);
  EXPECT_FALSE(request.labels);
  EXPECT_TRUE(request.label.empty());
  test::expect_error([&] { take_contours(request, 1); }, ErrorCode::BadArgument, "those of labels");
}

TEST(MaskContours, RefuseWhatIsNoTwoSlices) {
  test::expect_error([] { mask_contours(ball_mask(), 13); }, ErrorCode::BadArgument, "fewer than two");
  test::expect_error([] { mask_contours(ball_mask(), 0); }, ErrorCode::BadArgument, "every second");
}

}  // namespace
}  // namespace batten
