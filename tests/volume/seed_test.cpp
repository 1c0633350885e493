/// Surfaces from one seed: phantoms of known surfaces, leaks, borders.
#include <gtest/gtest.h>

#include <numbers>

#include "batten/error.h"
#include "batten/volume/front_times.h"
#include "batten/volume/seed_region.h"
#include "batten/volume/segment_volume.h"
#include "support/errors.h"
#include "volume/known_bodies.h"

namespace batten {
namespace {

using test::compared;
using test::imaged;
using test::kPhantoms;
using test::Phantom;
using test::Place;
using test::Truth;

SegmentResult from_seed(const Volume& image, const Place& seed, Index vertices = 386) {
  SegmentRequest request;
  request.seed = seed;
  request.surface.vertices = vertices;
  return segment_volume(image, request);
}

TEST(FrontTimes, AreDistancesWhereCostsAreOne) {
  VolumeGrid grid = test::centred_grid(21);
  grid.axes = Eigen::Vector3d(1.0, 2.0, 0.5).asDiagonal();
  const Front front =
      march_front(grid, Buffer<float>(static_cast<std::size_t>(grid.count()), 1.0F), grid.voxel(10, 10, 10));
  ASSERT_EQ(static_cast<std::ptrdiff_t>(front.order.size()), grid.count());
  EXPECT_FLOAT_EQ(front.times[grid.voxel(20, 10, 10)], 10.0F);
  EXPECT_FLOAT_EQ(front.times[grid.voxel(10, 0, 10)], 20.0F);
  const double far = std::hypot(10.0, 20.0, 5.0);
  EXPECT_NEAR(front.times[grid.voxel(20, 20, 20)], far, 0.1 * far) << "of first order across the axes";
  for (std::size_t n = 1; n < front.order.size(); ++n)
    EXPECT_LE(front.times[front.order[n - 1]], front.times[front.order[n]]);
}

/// How the bodies are imaged.
struct Imaged {
  double slice;  ///< mm
  double noise;
};

class SeedInBodies : public testing::TestWithParam<Imaged> {};

TEST_P(SeedInBodies, GivesTheirShapes) {
  const Imaged image = GetParam();
  const VolumeGrid grid = test::body_grid(image.slice);
  for (const Phantom& phantom : kPhantoms) {
    const SegmentResult found = from_seed(imaged(phantom, grid, image.noise), phantom.seed);
    const Truth truth = compared(found, phantom);
    EXPECT_GT(truth.dice, 0.98) << phantom.name;
    EXPECT_LT(truth.distance, 0.15 * std::cbrt(grid.voxel_volume())) << phantom.name;
    EXPECT_NEAR(truth.volume, 1.0, 0.01) << phantom.name;
    EXPECT_EQ(found.measures.self_intersections, 0);
    EXPECT_EQ(found.surface.genus, 0);
  }
}

// In slices three times as thick the blur across them is as wide as a third of the shape.
INSTANTIATE_TEST_SUITE_P(Image, SeedInBodies, testing::Values(Imaged{1.0, 0.1}, Imaged{3.0, 0.05}));

TEST(Seed, ADarkPartIsFoundAsWell) {
  Volume image = imaged(kPhantoms[0], test::centred_grid(40), 0.05);
  for (float& value : image.values) value = 100.0F - value;
  EXPECT_GT(compared(from_seed(image, {0, 0, 0}), kPhantoms[0]).dice, 0.98);
}

TEST(Seed, ARegionStopsBeforeItLeaks) {
  // A ball beside a larger one, joined by a pipe three voxels wide.
  const Phantom leak{"leak",
                     [](const Place& at) {
                       const double small = 8.0 - (at - Place(-14, 0, 0)).norm();
                       const double large = 11.0 - (at - Place(12, 0, 0)).norm();
                       const double pipe = std::min(1.5 - std::hypot(at[1], at[2]), 10.0 - std::abs(at[0]));
                       return std::max({small, large, pipe});
                     },
                     {-14, 0, 0}};
  const SeedRegion region = seed_region(imaged(leak, test::centred_grid(56), 0.05), leak.seed);
  const double ball = 4.0 / 3.0 * std::numbers::pi * 512.0;
  EXPECT_GT(region.volume, 0.6 * ball);
  EXPECT_LT(region.volume, 1.2 * ball);
  EXPECT_LT(region.edges_beyond, 1.0) << "twice as large it has fewer edges";
  EXPECT_LT(region.open, 0.1);
}

TEST(Seed, TellsThatABorderIsOpen) {
  // A rod that fades along x into the ground.
  const Volume image = test::made_volume(test::centred_grid(48), [](const Place& at) {
    const double side = 1.0 / (1.0 + std::exp((std::hypot(at[1], at[2]) - 7.0) / 0.6));
    const double foot = 1.0 / (1.0 + std::exp((-14.0 - at[0]) / 0.6));
    return 100.0 * side * foot * std::clamp(0.6 - at[0] / 36.0, 0.0, 1.0);
  });
  EXPECT_GT(seed_region(image, Place(-8, 0, 0)).open, 0.06);
  EXPECT_LT(seed_region(imaged(kPhantoms[0], test::centred_grid(40), 0.05), Place(0, 0, 0)).open, 0.02);
}

TEST(Seed, StaysInTheRangeThatIsGiven) {
  const Volume image = imaged(kPhantoms[0], test::centred_grid(40), 0.0);
  SeedOptions options;
  options.range = NumberRange{50.0, 200.0};
  const SeedRegion region = seed_region(image, Place(0, 0, 0), options);
  const double shape = 4.0 / 3.0 * std::numbers::pi * 14.0 * 10.0 * 9.0;
  EXPECT_NEAR(region.volume, shape, 0.15 * shape);
  options.range = NumberRange{150.0, 200.0};
  test::expect_error([&] { seed_region(image, Place(0, 0, 0), options); }, ErrorCode::BadArgument, "not in the range");
}

TEST(Seed, RefusesAFlatImageAndASeedOutside) {
  const Volume flat = test::made_volume(test::centred_grid(20), [](const Place&) { return 3.0; });
  test::expect_error([&] { seed_region(flat, Place(0, 0, 0)); }, ErrorCode::BadArgument, "nothing with edges");
  test::expect_error([&] { seed_region(flat, Place(40, 0, 0)); }, ErrorCode::BadArgument, "outside the image");
}

TEST(Seed, ASurfaceAtTheBorderOfTheVolumeStaysInside) {
  const Phantom dome{"dome", [](const Place& at) { return 9.0 - (at - Place(0, 0, 14)).norm(); }, {0, 0, 14}};
  const VolumeGrid grid = test::centred_grid(33);
  const SegmentResult found = from_seed(imaged(dome, grid, 0.05), dome.seed, 150);
  const Points indices = grid.to_indices(found.measures.fine.points);
  EXPECT_GT(indices.minCoeff(), -0.5 - 1e-9);
  EXPECT_LT(indices.maxCoeff(), 32.5 + 1e-9);
  EXPECT_GT(indices.col(2).maxCoeff(), 31.0) << "it reaches the border";
  EXPECT_EQ(found.measures.self_intersections, 0);
}

TEST(SegmentVolume, AMeshIsDrawnToTheEdgesFromNearby) {
  const Volume image = imaged(kPhantoms[0], test::centred_grid(40), 0.05);
  SegmentRequest request;
  request.start = from_seed(image, {0, 0, 0}, 200).surface.mesh;
  request.start->points *= 0.9;
  const SegmentResult found = segment_volume(image, request);
  EXPECT_EQ(found.surface.mesh.face_vertices, request.start->face_vertices) << "the same control mesh, moved";
  EXPECT_GT(compared(found, kPhantoms[0]).dice, 0.98);
  EXPECT_EQ(found.surface.genus, 0);
}

TEST(SegmentVolume, RefusesThreePlatesWhoseSurfaceDoesNotClose) {
  const auto plates = [](const Place& at) { return at.cwiseAbs().minCoeff() == 0.0 && at.norm() < 17.0 ? 1 : 0; };
  SegmentRequest request;
  request.surface.vertices = 60;
  test::expect_error([&] { segment_volume(test::made_volume(test::centred_grid(41), plates), request); },
                     ErrorCode::NotConverged, "too thin");
}

TEST(SegmentVolume, RefusesAnOpenMeshAnotherWorldAndTwoStarts) {
  const Volume image = imaged(kPhantoms[0], test::centred_grid(40), 0.0);
  SegmentRequest request;
  Mesh square;
  square.points = 3.0 * Points::Random(4, 3);
  square.add_face({0, 1, 2, 3});
  request.start = square;
  test::expect_error([&] { segment_volume(image, request); }, ErrorCode::BadArgument, "has holes");
  request.start = from_seed(image, {0, 0, 0}, 100).surface.mesh;
  request.start->points.array() += 100.0;
  test::expect_error([&] { segment_volume(image, request); }, ErrorCode::BadArgument, "does not lie in the image");
  request.seed = Place(0, 0, 0);
  test::expect_error([&] { segment_volume(image, request); }, ErrorCode::BadArgument, "from points, from a seed");
}

}  // namespace
}  // namespace batten
