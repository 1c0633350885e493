#include "batten/volume/image_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "batten/error.h"
#include "batten/mesh/primitives.h"
#include "batten/volume/gaussian_filter.h"
#include "support/errors.h"
#include "volume/phantoms.h"

namespace batten {
namespace {

constexpr double kSlice = 2.0;
constexpr double kSigma = 1.8;

VolumeGrid thick_grid() {
  VolumeGrid grid;
  grid.size = {24, 24, 40};
  grid.axes = Eigen::Vector3d(1.0, 1.0, kSlice).asDiagonal();
  grid.origin = -grid.axes * Eigen::Vector3d(11.5, 11.5, 19.5);
  return grid;
}

/// The integral of the normal distribution's integral.
double twice_integrated(double x) {
  return 0.5 * x * (1.0 + std::erf(x / std::numbers::sqrt2)) +
         std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
}

/// Bright below a height, blurred by a Gaussian along z, mean of each voxel: a closed form.
Volume blurred_floor(double height) {
  return test::made_volume(thick_grid(), [&](const Eigen::Vector3d& at) {
    const double low = (height - at[2] - 0.5 * kSlice) / kSigma;
    const double high = (height - at[2] + 0.5 * kSlice) / kSigma;
    return 40.0 + 100.0 * kSigma / kSlice * (twice_integrated(high) - twice_integrated(low));
  });
}

/// A box beyond the volume's other sides with its top at a height.
Mesh box_below(double height) {
  Mesh box = cube();
  for (Index v = 0; v < 8; ++v) {
    for (int c = 0; c < 3; ++c) box.points(v, c) = box.points(v, c) > 0.0 ? 60.0 : -60.0;
    if (box.points(v, 2) > 0.0) box.points(v, 2) = height;
  }
  return box;
}

TEST(GaussianSmoothed, AddsItsVarianceAlongEachIndex) {
  const Eigen::Vector3d sigmas(1.3, 0.0, 0.8);
  const auto bell = [](double variance, double x) { return std::exp(-0.5 * x * x / variance) / std::sqrt(variance); };
  const Volume narrow = test::made_volume(test::centred_grid(31), [&](const Eigen::Vector3d& at) {
    return bell(4.0, at[0]) * bell(5.0, at[1]) * bell(3.0, at[2]);
  });
  const Volume found = gaussian_smoothed(narrow, sigmas);
  for (Index i = 8; i < 23; ++i) {
    for (Index j = 8; j < 23; ++j) {
      const double wanted = bell(4.0 + 1.3 * 1.3, i - 15.0) * bell(5.0, j - 15.0) * bell(3.0 + 0.8 * 0.8, i - 15.0);
      EXPECT_NEAR(found.at(i, j, i), wanted, 2e-4 * 0.13);
    }
  }
  test::expect_error([&] { gaussian_smoothed(narrow, {1.0, -1.0, 0.0}); }, ErrorCode::BadArgument, "0 voxels or more");
}

TEST(ImageModel, AsksForTheWayToTheEdgeAndLearnsTheBlur) {
  // In the middle of a slice. A plane there cuts voxels in halves, whose variance of h^2 / 4 is h^2 / 12 more than that
  // of all heights in the mean: the blur beside it is less by that.
  constexpr double kHeight = 0.5 * kSlice;
  ImageModel model(blurred_floor(kHeight));
  Points places(3, 3);
  places << 0, 0, 0, 3, 2, 0, -2, 4, 0;
  Points normals = Points::Zero(3, 3);
  normals.col(2).setOnes();
  double height = -0.6;
  for (int round = 0; round < 30; ++round) {
    model.set_surface(box_below(height));
    model.learn_blur();
    places.col(2).setConstant(height);
    const ModelMoves asked = model.moves(places, normals);
    EXPECT_LT(asked.moves.maxCoeff() - asked.moves.minCoeff(), 1e-3);
    if (round == 0) {
      EXPECT_GT(asked.moves[0], 0.2 * (kHeight - height));
      EXPECT_LT(asked.moves[0], kHeight - height);
    }
    height += asked.moves[0];
  }
  EXPECT_NEAR(height, kHeight, 0.005);
  EXPECT_NEAR(model.blur()[2], kSigma * kSigma, 0.15);
  EXPECT_GT(model.moves(places, normals).weights.minCoeff(), 0.999);
  EXPECT_LT(model.noise(), 1e-3);
}

TEST(ImageModel, SeesTheShareOfNoise) {
  Volume image = blurred_floor(0.0);
  std::uint32_t state = 1;
  for (float& value : image.values) {
    state = state * 1664525U + 1013904223U;
    value += 10.0F * (static_cast<float>(state >> 8) / 16777216.0F - 0.5F) * std::sqrt(12.0F);
  }
  ImageModel model(image);
  for (int round = 0; round < 8; ++round) {
    model.set_surface(box_below(0.0));
    model.learn_blur();
  }
  // A variance of 100, of that and of a step of 100 seen evenly on both sides.
  EXPECT_GT(model.noise(), 100.0 / (100.0 + 2500.0));
  EXPECT_LT(model.noise(), 100.0 / (100.0 + 700.0));
}

TEST(ImageModel, AFlatImageAsksForNothing) {
  ImageModel model(test::made_volume(thick_grid(), [](const Eigen::Vector3d&) { return 7.0; }));
  model.set_surface(box_below(0.0));
  model.learn_blur();
  const ModelMoves asked = model.moves(Points::Zero(1, 3), Eigen::RowVector3d(0, 0, 1));
  EXPECT_EQ(asked.moves[0], 0.0);
  EXPECT_EQ(asked.weights[0], 0.0);
  test::expect_error([&] { model.moves(Points::Zero(2, 3), Points::Zero(1, 3)); }, ErrorCode::BadShape, "a normal");
}

}  // namespace
}  // namespace batten
