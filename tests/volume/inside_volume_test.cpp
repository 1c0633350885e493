#include "batten/volume/inside_volume.h"

#include <gtest/gtest.h>

#include <numeric>

#include "batten/error.h"
#include "batten/mesh/primitives.h"
#include "batten/tessellate/surface_mesh.h"
#include "support/errors.h"
#include "volume/phantoms.h"

namespace batten {
namespace {

double sum_of(const Volume& volume) { return std::accumulate(volume.values.begin(), volume.values.end(), 0.0); }

TEST(InsideVolume, PartsOfABoxAreProducts) {
  Mesh box = cube();
  const Eigen::Vector3d low(-2.3, -1.8, -2.0625);
  const Eigen::Vector3d high(1.6, 2.25, 1.4375);
  for (Index v = 0; v < 8; ++v) {
    for (int c = 0; c < 3; ++c) box.points(v, c) = box.points(v, c) > 0.0 ? high[c] : low[c];
  }
  const Volume parts = inside_volume(box, test::centred_grid(7), VoxelRule::Part);
  const auto share = [&](int c, Index i) {
    const double middle = i - 3.0;
    return std::max(0.0, std::min(high[c], middle + 0.5) - std::max(low[c], middle - 0.5));
  };
  double worst = 0.0;
  for (Index k = 0; k < 7; ++k) {
    for (Index j = 0; j < 7; ++j) {
      for (Index i = 0; i < 7; ++i)
        worst = std::max(worst, std::abs(parts.at(i, j, k) - share(0, i) * share(1, j) * share(2, k)));
    }
  }
  EXPECT_LT(worst, 1e-6) << "floats";
  EXPECT_NEAR(sum_of(parts), (high - low).prod(), 1e-5);
}

TEST(InsideVolume, PartsAreSharesOfFinerVoxels) {
  const Mesh control = torus(24, 12, 8.0, 3.0);
  const Mesh fine = surface_mesh(Topology(control), Scheme(), control, 3);
  const VolumeGrid grid = test::centred_grid(25);
  const Volume parts = inside_volume(fine, grid, VoxelRule::Part);
  VolumeGrid finer = grid;
  finer.size = {100, 100, 100};
  finer.axes /= 4.0;
  finer.origin = grid.to_world(Eigen::Vector3d::Constant(-0.5)) + finer.axes * Eigen::Vector3d::Constant(0.5);
  const Volume samples = inside_volume(fine, finer, VoxelRule::Part);
  const Volume centres = inside_volume(fine, finer, VoxelRule::Centre);
  double worst = 0.0;
  double counted = 0.0;
  for (Index k = 0; k < 25; ++k) {
    for (Index j = 0; j < 25; ++j) {
      for (Index i = 0; i < 25; ++i) {
        double sum = 0.0;
        double inside = 0.0;
        for (int s = 0; s < 64; ++s) {
          sum += samples.at(4 * i + s % 4, 4 * j + s / 4 % 4, 4 * k + s / 16);
          inside += centres.at(4 * i + s % 4, 4 * j + s / 4 % 4, 4 * k + s / 16);
        }
        worst = std::max(worst, std::abs(sum / 64.0 - parts.at(i, j, k)));
        counted = std::max(counted, std::abs(inside / 64.0 - parts.at(i, j, k)));
      }
    }
  }
  EXPECT_LT(worst, 1e-5) << "floats";
  EXPECT_LT(counted, 0.13) << "the independent count of 64 places";
}

TEST(InsideVolume, CentresAreInsideOnEveryHandedness) {
  const Mesh control = torus(12, 8, 8.0, 3.0);
  const Mesh fine = surface_mesh(Topology(control), Scheme(), control, 3);
  VolumeGrid grid = test::centred_grid(25);
  const Volume plain = inside_volume(fine, grid, VoxelRule::Centre);
  EXPECT_EQ(plain.at(12, 12, 12), 0.0F) << "the hole";
  EXPECT_EQ(plain.at(20, 12, 12), 1.0F);
  const Volume turned = test::rearranged(plain, {1, 0, 2}, {true, false, false});
  const Volume again = inside_volume(fine, turned.grid, VoxelRule::Centre);
  EXPECT_EQ(again.values, turned.values);
}

TEST(InsideVolume, AVolumeThatCutsTheSurfaceHoldsItsPart) {
  const Mesh box = cube();
  VolumeGrid grid;
  grid.size = {4, 4, 4};
  grid.axes *= 0.25;
  grid.origin = Eigen::Vector3d::Constant(-0.3);
  EXPECT_EQ(sum_of(inside_volume(box, grid, VoxelRule::Part)), 64.0);
}

TEST(InsideVolume, RefusesOpenMeshes) {
  test::expect_error([&] { inside_volume(grid(2, 2), test::centred_grid(3), VoxelRule::Part); }, ErrorCode::BadArgument,
                     "open");
}

}  // namespace
}  // namespace batten
