/// What is judged of a large cloud by a few of its points.
#include <gtest/gtest.h>

#include <vector>

#include "batten/fit/fit_surface.h"
#include "batten/fit/outliers.h"
#include "batten/fit/thin_cloud.h"
#include "batten/quantile.h"
#include "fit/clouds.h"

namespace batten {
namespace {

using test::CloudMaker;

constexpr Index kClean = 40000;
constexpr Index kThin = 4000;

Points thinned(const Points& points) { return points(thinned_rows(points, kThin), Eigen::all); }

Scalars off_unit_sphere(const Points& points) { return (points.rowwise().norm().array() - 1.0).abs(); }

TEST(LargeCloud, SpacingIsThatOfAllPoints) {
  const Points points = CloudMaker().sphere(kClean);
  Buffer<double> nearest = find_neighbours(PointTree(points), 1).distances;
  const double exact = quantile(nearest, 0.5);
  const double reach = OutlierFilter(thinned(points)).spacing();
  EXPECT_GT(reach, 2.0 * exact) << "what is thinned is farther apart";
  EXPECT_NEAR(sampled_spacing(points, reach), exact, 0.03 * exact) << "thousands of random distances";
}

/// The last rows are outliers, anywhere in the box of a unit sphere's points.
TEST(LargeCloud, FarPointsAreOutliers) {
  const Points points = CloudMaker(5).with_outliers(CloudMaker().sphere(kClean), 0.01);
  const Scalars distances = off_unit_sphere(points);
  const Points few = thinned(points);
  const OutlierFilter filter(few);
  const double spacing = sampled_spacing(points, filter.spacing());
  const Buffer<std::uint8_t> flags = filter.far_of(points, distances, off_unit_sphere(few), spacing);
  for (Index i = 0; i < static_cast<Index>(points.rows()); ++i) {
    if (i < kClean) {
      EXPECT_EQ(flags[i], 0) << i;
    } else if (distances[i] > 0.1) {
      EXPECT_EQ(flags[i], 1) << i << " is " << distances[i] << " away";
    }
  }
}

/// The surface misses a cap of the sphere: its points are far, but all of them.
TEST(LargeCloud, APartThatIsFarAsAWholeIsNone) {
  const Points points = CloudMaker().sphere(kClean);
  const auto miss = [](const Points& of) -> Scalars { return (of.col(2).array() - 0.8).max(1e-6); };
  const Points few = thinned(points);
  const OutlierFilter filter(few);
  const double spacing = sampled_spacing(points, filter.spacing());
  for (const std::uint8_t flag : filter.far_of(points, miss(points), miss(few), spacing)) EXPECT_EQ(flag, 0);
}

TEST(LargeCloud, FitFollowsAllOfIt) {
  const Points clean = CloudMaker().sphere(kClean);
  FitOptions options;
  options.start = FitStart::Sphere;
  options.vertices = 98;
  const FitResult fit = fit_surface({CloudMaker(5).with_outliers(clean, 0.01), Points(0, 3)}, options);
  EXPECT_GT(fit.report.outliers, 300);
  EXPECT_LE(fit.report.outliers, 400);
  EXPECT_LT(fit.report.to_surface.rms, 2e-3 * fit.report.diameter);
  EXPECT_EQ(fit.distances.size(), kClean + 400);
}

}  // namespace
}  // namespace batten
