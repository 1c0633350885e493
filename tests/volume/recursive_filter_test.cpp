#include "batten/volume/recursive_filter.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "batten/error.h"
#include "support/errors.h"
#include "volume/phantoms.h"

namespace batten {
namespace {

/// The kernels of the header, summed over whole numbers for k and c.
struct Kernel {
  FilterOrder order;
  double a;
  double spacing;
  static constexpr int kReach = 400;

  double shape(int m, double c) const {
    const double fall = std::exp(-a * std::abs(m));
    if (order == FilterOrder::Smooth) return (a * std::abs(m) + 1.0) * fall;
    return order == FilterOrder::First ? -m * fall : (1.0 - c * std::abs(m)) * fall;
  }
  double sum(double c, const std::function<double(double)>& of) const {
    double total = 0.0;
    for (int m = -kReach; m <= kReach; ++m) total += shape(m, c) * of(m);
    return total;
  }
  std::vector<double> weights() const {
    double c = 0.0;
    if (order == FilterOrder::Second) {
      const double plain = sum(0.0, [](double) { return 1.0; });
      c = plain / (plain - sum(1.0, [](double) { return 1.0; }));
    }
    const double unit = order == FilterOrder::Smooth ? sum(c, [](double) { return 1.0; })
                        : order == FilterOrder::First
                            ? sum(c, [&](double m) { return -m * spacing; })
                            : sum(c, [&](double m) { return 0.5 * m * m * spacing * spacing; });
    std::vector<double> all;
    for (int m = -kReach; m <= kReach; ++m) all.push_back(shape(m, c) / unit);
    return all;
  }
};

TEST(RecursiveFilter, EqualsDirectConvolution) {
  constexpr double kAlpha = 0.7;
  VolumeGrid grid;
  grid.size = {70, 5, 9};
  grid.axes = Eigen::Vector3d(0.8, 1.5, 3.0).asDiagonal();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  const Volume noise = test::made_volume(grid, [&](const Eigen::Vector3d&) { return number(random); });
  for (const FilterOrder order : {FilterOrder::Smooth, FilterOrder::First, FilterOrder::Second}) {
    for (int axis = 0; axis < 3; ++axis) {
      std::array<FilterOrder, 3> orders{};
      orders[axis] = order;
      const Volume fast = filtered(noise, orders, kAlpha);
      const double spacing = grid.spacing(axis);
      const std::vector<double> weights = Kernel{order, kAlpha * spacing, spacing}.weights();
      double worst = 0.0;
      for (Index k = 0; k < grid.size[2]; ++k) {
        for (Index j = 0; j < grid.size[1]; ++j) {
          for (Index i = 0; i < grid.size[0]; ++i) {
            const std::array<Index, 3> at{i, j, k};
            double direct = 0.0;
            for (int m = -Kernel::kReach; m <= Kernel::kReach; ++m) {
              std::array<Index, 3> from = at;
              from[axis] = std::clamp(at[axis] - m, 0, grid.size[axis] - 1);
              direct += weights[m + Kernel::kReach] * noise.at(from[0], from[1], from[2]);
            }
            worst = std::max(worst, std::abs(direct - fast.at(i, j, k)));
          }
        }
      }
      EXPECT_LT(worst, 1e-6) << "order " << static_cast<int>(order) << " axis " << axis;
    }
  }
}

TEST(RecursiveFilter, DerivativesOfPolynomialsAreExactAtAnySpacing) {
  VolumeGrid grid = test::centred_grid(81);
  grid.axes = Eigen::Vector3d(0.5, 1.0, 0.5).asDiagonal();
  const Volume parabola =
      test::made_volume(grid, [](const Eigen::Vector3d& at) { return 3.0 * at[0] + at[0] * at[0]; });
  const Volume slope = filtered(parabola, {FilterOrder::First, FilterOrder::Smooth, FilterOrder::None}, 2.0);
  const Volume bend = filtered(parabola, {FilterOrder::Second, FilterOrder::None, FilterOrder::Smooth}, 2.0);
  const Eigen::Vector3d middle = grid.to_world({40.0, 40.0, 40.0});
  EXPECT_NEAR(slope.at(40, 40, 40), 3.0 + 2.0 * middle[0], 2e-4);
  EXPECT_NEAR(bend.at(40, 40, 40), 2.0, 2e-3);
}

TEST(RecursiveFilter, TheGradientIsTheSameInAnObliqueVolume) {
  const Eigen::Vector3d slope(2.0, -1.0, 0.5);
  VolumeGrid grid = test::centred_grid(40);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.6, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  grid.axes = turn * Eigen::Vector3d(1.0, 0.7, 2.0).asDiagonal();
  const Volume ramp = test::made_volume(grid, [&](const Eigen::Vector3d& at) { return slope.dot(at); });
  const Gradient found = gradient(ramp, 1.5);
  EXPECT_LT((world_gradient(found, {20.3, 19.1, 20.7}) - slope).norm(), 1e-4);
}

TEST(RecursiveFilter, EdgesOfAStepStandBetweenItsSides) {
  // A step at x = 0.25 voxels beyond the middle, by the share of the voxel there.
  const Volume step = test::made_volume(test::centred_grid(31),
                                        [](const Eigen::Vector3d& at) { return std::clamp(at[0] + 0.25, 0.0, 1.0); });
  const Volume maxima = edge_maxima(gradient(step, 1.0));
  for (Index i = 0; i < 31; ++i) {
    const bool at_step = i == 15;
    EXPECT_EQ(maxima.at(i, 15, 15) > 0.05F, at_step) << i;
  }
}

TEST(RecursiveFilter, RefusesWhatMakesNoSense) {
  const Volume flat = test::made_volume(test::centred_grid(3), [](const Eigen::Vector3d&) { return 1.0; });
  test::expect_error([&] { gradient(flat, 0.0); }, ErrorCode::BadArgument, "alpha");
  Volume broken = flat;
  broken.values[5] = std::numeric_limits<float>::quiet_NaN();
  test::expect_error([&] { gradient(broken, 1.0); }, ErrorCode::NotFinite, "voxel (2, 1, 0)");
}

}  // namespace
}  // namespace batten
