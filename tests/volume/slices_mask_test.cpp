#include "batten/volume/slices_mask.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

#include "batten/error.h"
#include "batten/volume/segment_volume.h"
#include "support/errors.h"
#include "volume/phantoms.h"

namespace batten {
namespace {

using std::numbers::pi;
using Place = Eigen::Vector3d;

/// Places where `inside` changes its sign in slices z = levels, along lines 0.8 apart.
template <typename Inside>
Points contours(const Inside& inside, const std::vector<double>& levels) {
  constexpr double kStep = 0.8;
  constexpr Index kHalf = 40;
  std::vector<Place> places;
  const auto add = [&](const Place& from, const Place& to) {
    if ((inside(from) > 0.0) == (inside(to) > 0.0)) return;
    Place in = inside(from) > 0.0 ? from : to;
    Place out = inside(from) > 0.0 ? to : from;
    for (int halving = 0; halving < 40; ++halving) (inside(0.5 * (in + out)) > 0.0 ? in : out) = 0.5 * (in + out);
    places.push_back(in);
  };
  for (const double level : levels) {
    for (Index j = -kHalf; j <= kHalf; ++j) {
      for (Index i = -kHalf; i < kHalf; ++i) {
        add({kStep * i, kStep * j, level}, {kStep * (i + 1), kStep * j, level});
        add({kStep * j, kStep * i, level}, {kStep * j, kStep * (i + 1), level});
      }
    }
  }
  Points points(static_cast<Eigen::Index>(places.size()), 3);
  for (Eigen::Index row = 0; row < points.rows(); ++row) points.row(row) = places[row].transpose();
  return points;
}

std::vector<double> every(double step, double from, double to) {
  std::vector<double> levels;
  for (double level = from; level <= to; level += step) levels.push_back(level);
  return levels;
}

double ellipsoid(const Place& at) { return 1.0 - at.cwiseQuotient(Place(14, 9, 11)).norm(); }

Eigen::Matrix3d some_turn() { return Eigen::AngleAxisd(0.7, Place(3, 1, 2).normalized()).toRotationMatrix(); }

/// In another order and direction.
Points shuffled(const Points& points, const Eigen::Matrix3d& turn) {
  std::vector<Eigen::Index> rows(static_cast<std::size_t>(points.rows()));
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = static_cast<Eigen::Index>(i);
  std::mt19937 random(3);
  std::shuffle(rows.begin(), rows.end(), random);
  return points(rows, Eigen::all) * turn.transpose();
}

/// Twice the common volume by the sum of both, by places 0.5 apart; `turn` takes the shape to where the mask is.
template <typename Inside>
double likeness(const Volume& mask, const Inside& inside, const Eigen::Matrix3d& turn = Eigen::Matrix3d::Identity()) {
  double common = 0.0;
  double sum = 0.0;
  const VolumeGrid grid = test::centred_grid(120, 0.5);
  for (Index k = 0; k < grid.size[2]; ++k) {
    for (Index j = 0; j < grid.size[1]; ++j) {
      for (Index i = 0; i < grid.size[0]; ++i) {
        const Place at = grid.to_world(Place(i, j, k));
        const Place index = mask.grid.to_indices(Points((turn * at).transpose())).row(0).transpose();
        bool is_near = true;
        for (int c = 0; c < 3; ++c) is_near = is_near && index[c] >= 0.0 && index[c] <= mask.grid.size[c] - 1.0;
        const bool in_mask = is_near && interpolated(mask, index) > 0.5;
        const bool in_shape = inside(at) > 0.0;
        common += in_mask && in_shape ? 1.0 : 0.0;
        sum += (in_mask ? 1.0 : 0.0) + (in_shape ? 1.0 : 0.0);
      }
    }
  }
  return 2.0 * common / sum;
}

TEST(PointSlices, ObliqueOnesOfShuffledPointsAreFound) {
  const Points points = contours(ellipsoid, every(4.0, -9.0, 9.0));
  const std::optional<PointSlices> slices = find_slices(shuffled(points, some_turn()));
  ASSERT_TRUE(slices);
  ASSERT_EQ(slices->levels.size(), 5U);
  EXPECT_NEAR(std::abs(slices->axes.col(2).dot(some_turn().col(2))), 1.0, 1e-12);
  for (std::size_t i = 1; i < slices->levels.size(); ++i)
    EXPECT_NEAR(slices->levels[i] - slices->levels[i - 1], 4.0, 1e-9);
  std::size_t rows = 0;
  for (const auto& slice : slices->rows) rows += slice.size();
  EXPECT_EQ(rows, static_cast<std::size_t>(points.rows()));
}

TEST(PointSlices, PointsAllOverASurfaceHaveNone) {
  Points points(200, 3);
  std::mt19937 random(7);
  std::normal_distribution<double> scatter;
  for (Eigen::Index row = 0; row < points.rows(); ++row)
    points.row(row) = Place(scatter(random), scatter(random), scatter(random)).normalized().transpose();
  EXPECT_FALSE(find_slices(points));
  EXPECT_FALSE(find_slices(contours(ellipsoid, {0.0}))) << "one slice is none";
  EXPECT_FALSE(find_slices(contours(ellipsoid, every(0.2, -9.0, 9.0)))) << "closer than the points of a slice";
}

TEST(SlicesMask, AnEllipsoidIsFilledAlsoBeyondTheLastSlices) {
  const Points points = contours(ellipsoid, every(4.0, -9.0, 9.0));
  for (const Eigen::Matrix3d& turn : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), some_turn()}) {
    const Points placed = shuffled(points, turn);
    const Volume mask = slices_mask(placed, *find_slices(placed));
    double volume = 0.0;
    for (const float value : mask.values) volume += value * mask.grid.voxel_volume();
    const double whole = 4.0 / 3.0 * pi * 14.0 * 9.0 * 11.0;
    EXPECT_NEAR(volume, whole, 0.02 * whole);
    EXPECT_GT(likeness(mask, ellipsoid, turn), 0.975);
  }
}

/// An arc of a torus, which slices along z cut twice, and once at its top.
double arch(const Place& at) {
  if (at[2] < -8.0) return -1.0;
  const double far = std::hypot(at[0], std::max(0.0, at[2]));
  return 3.5 - (at[2] < 0.0 ? std::hypot(std::abs(at[0]) - 10.0, at[1]) : std::hypot(far - 10.0, at[1]));
}

TEST(SlicesMask, TwoContoursOfASliceJoinInTheNext) {
  const Points points = contours(arch, every(3.0, -7.0, 13.0));
  const Volume mask = slices_mask(points, *find_slices(points));
  EXPECT_GT(likeness(mask, arch), 0.94);
  SegmentOptions options;
  options.vertices = 200;
  const Segmentation found = segment_mask(mask, options);
  EXPECT_EQ(found.components, 1);
  EXPECT_EQ(found.genus, 0);
}

/// A thick tube along z.
double pipe(const Place& at) {
  return std::min(3.0 - std::abs(std::hypot(at[0], at[1]) - 9.0), 10.0 - std::abs(at[2]));
}

/// A rod 2.4 wide that moves by 6 from slice to slice, where these are 4 apart.
double flat_rod(const Place& at) {
  const Place along = Place(6, 0, 4).normalized();
  const double far = std::clamp(at.dot(along), -18.0, 18.0);
  return 1.2 - (at - far * along).norm();
}

TEST(SlicesMask, AThinPartThatMovesByMoreThanItsWidthStaysWhole) {
  const Points points = contours(flat_rod, every(4.0, -8.0, 9.0));
  const Volume mask = slices_mask(points, *find_slices(points));
  SegmentOptions options;
  options.vertices = 200;
  EXPECT_EQ(segment_mask(mask, options).components, 1);
  EXPECT_GT(likeness(mask, flat_rod), 0.8) << "half a cell of the test all around is 0.25 of it";
}

/// Two balls, the upper one far to the side of the lower one.
double two_balls(const Place& at) {
  return std::max(6.0 - (at - Place(-14, 0, -8)).norm(), 6.0 - (at - Place(14, 0, 8)).norm());
}

TEST(SlicesMask, PartsThatAreFartherApartThanSlicesStayApart) {
  const Points points = contours(two_balls, every(4.0, -12.0, 13.0));
  const Volume mask = slices_mask(points, *find_slices(points));
  SegmentOptions options;
  options.vertices = 200;
  EXPECT_EQ(segment_mask(mask, options).components, 2);
  EXPECT_GT(likeness(mask, two_balls), 0.87) << "three slices a ball";
}

TEST(SlicesMask, HolesOfSlicesStayOpen) {
  const Points points = contours(pipe, every(4.0, -8.0, 8.0));
  const Volume mask = slices_mask(points, *find_slices(points));
  EXPECT_GT(likeness(mask, pipe), 0.95);
  SegmentOptions options;
  options.vertices = 200;
  EXPECT_EQ(segment_mask(mask, options).genus, 1);
}

TEST(SlicesMask, MissingPointsDoNotOpenAContour) {
  const Points all = shuffled(contours(ellipsoid, every(4.0, -9.0, 9.0)), Eigen::Matrix3d::Identity());
  const Points points = all.topRows(all.rows() / 2);
  const std::optional<PointSlices> slices = find_slices(points);
  ASSERT_TRUE(slices);
  EXPECT_GT(likeness(slices_mask(points, *slices), ellipsoid), 0.96);
}

TEST(SlicesMask, RefusesWhatItCannotFill) {
  Points line(40, 3);
  for (Eigen::Index row = 0; row < 40; ++row) line.row(row) << 0.1 * (row % 20), 0.0, row / 20;
  EXPECT_FALSE(find_slices(line)) << "they lie in other planes as well";
  const Points points = contours(ellipsoid, every(4.0, -9.0, 9.0));
  const PointSlices slices = *find_slices(points);
  test::expect_error([&] { slices_mask(points, slices, 300); }, ErrorCode::BadArgument, "8 to 256");
  PointSlices two = slices;
  for (auto& rows : two.rows) rows.resize(1);
  test::expect_error([&] { slices_mask(points, two); }, ErrorCode::BadArgument, "on a line");
}

TEST(SegmentVolume, ASurfaceFromSlicesPassesThroughThemAndKeepsItsEnds) {
  const Points points = contours(ellipsoid, every(4.0, -9.0, 9.0));
  const Volume flat = test::made_volume(test::centred_grid(41), [](const Place&) { return 5.0; });
  SegmentRequest request;
  request.points = points;
  request.surface.vertices = 200;
  const SegmentResult found = segment_volume(flat, request);
  EXPECT_EQ(found.measures.self_intersections, 0);
  const double whole = 4.0 / 3.0 * pi * 14.0 * 9.0 * 11.0;
  EXPECT_NEAR(found.measures.volume, whole, 0.02 * whole);
  double most = 0.0;
  for (Eigen::Index row = 0; row < found.measures.fine.points.rows(); ++row)
    most = std::max(most, std::abs(ellipsoid(found.measures.fine.points.row(row).transpose())));
  EXPECT_LT(most, 0.12) << "1 at the middle: the ends, 2 beyond the last slices, are within a tenth";
}

}  // namespace
}  // namespace batten
