#include "batten/dynamics/surface_samples.h"

#include <gtest/gtest.h>

#include <numeric>

#include "batten/error.h"
#include "batten/surface/surface_weights.h"
#include "support/shapes.h"
#include "support/values.h"

namespace batten {
namespace {

TEST(SurfaceSamples, JetsAreThoseOfTheLimitSurface) {
  test::for_each_sample([](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    const SurfacePatches patches(Topology(mesh), scheme);
    const LimitSurface surface(patches, mesh.points);
    const SurfaceSamples samples(patches, GaussSamples{{2, 3}});
    const Points jets = samples.evaluate(mesh.points);
    double error = 0.0;
    for (std::ptrdiff_t i = 0; i < samples.count(); ++i) {
      const Jet jet = surface.jet(samples.place(i));
      error = std::max(error, (jets.row(3 * i).transpose() - jet.point).norm());
      error = std::max(error, (jets.row(3 * i + 1).transpose() - jet.du).norm());
      error = std::max(error, (jets.row(3 * i + 2).transpose() - jet.dv).norm());
    }
    EXPECT_LT(error, 1e-11) << name;
  });
}

TEST(SurfaceSamples, GridsReachTheCornersAndCountAsTheFace) {
  test::for_each_sample([](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    const SurfacePatches patches(Topology(mesh), scheme);
    const LimitSurface surface(patches, mesh.points);
    const SurfaceSamples samples(patches, GridSamples{3});
    const Points points = samples.evaluate(mesh.points);
    for (Index e = 0; e < samples.elements().count(); ++e) {
      const std::vector<double>& weights = samples.table(e).weights;
      EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), patches.quads() ? 1.0 : 0.5, 1e-14) << name;
      const Jet corner = surface.jet({samples.elements().base_face(e), 0.0, 0.0});
      EXPECT_NEAR((points.row(samples.begin(e)).transpose() - corner.point).norm(), 0.0, 1e-3) << name;
    }
  });
}

TEST(SurfaceSamples, PullsBackByTheTransposedWeights) {
  test::for_each_sample([](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    const SurfaceSamples samples(SurfacePatches(Topology(mesh), scheme), GaussSamples{{3, 2}});
    const Points forces = test::random_values(static_cast<Index>(3 * samples.count()), 3);
    const double there = forces.cwiseProduct(samples.evaluate(mesh.points)).sum();
    const double back = samples.pull_back(forces).cwiseProduct(mesh.points).sum();
    EXPECT_NEAR(back, there, 1e-11 * forces.norm() * (1.0 + std::abs(there))) << name;
  });
}

TEST(SurfaceSamples, ForcesOnPointsAreThoseWithoutDerivatives) {
  const Mesh mesh = test::jittered(dodecahedron(), 0.1, 3);
  const SurfaceSamples samples(SurfacePatches(Topology(mesh), Scheme{}), GaussSamples{{3, 2}});
  const Points forces = test::random_values(static_cast<Index>(samples.count()), 3);
  Points all = Points::Zero(3 * samples.count(), 3);
  for (std::ptrdiff_t i = 0; i < samples.count(); ++i) all.row(3 * i) = forces.row(i);
  EXPECT_NEAR((samples.pull_back(forces) - samples.pull_back(all)).norm(), 0.0, 1e-13);
}

TEST(SurfaceSamples, RowsAreThoseOfSurfaceWeights) {
  test::for_each_sample([](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    const SurfacePatches patches(Topology(mesh), scheme);
    const SurfaceSamples samples(patches, GaussSamples{{2, 1}});
    std::vector<std::ptrdiff_t> some;
    std::vector<SurfacePlace> places;
    for (std::ptrdiff_t i = 0; i < samples.count(); i += 3) {
      some.push_back(i);
      places.push_back(samples.place(i));
    }
    const auto rows = samples.point_rows(some);
    EXPECT_NEAR((rows->rows - SurfaceWeights(patches).rows(places)).norm(), 0.0, 1e-12) << name;
    EXPECT_EQ((PlaceRows::Matrix(rows->rows.transpose()) - rows->transposed).norm(), 0.0) << name;
  });
}

TEST(SurfaceSamples, AreasSumToThatOfTheSurface) {
  const Mesh mesh = test::jittered(torus(8, 6), 0.02, 3);
  const SurfacePatches patches(Topology(mesh), Scheme{});
  const double area = area_weights(LimitSurface(patches, mesh.points), surface_quadrature(patches, {8, 0})).sum();
  EXPECT_NEAR(element_areas(patches, mesh.points).sum(), area, 1e-3 * area);
  const SurfaceSamples samples(patches, GaussSamples{{8, 0}});
  EXPECT_NEAR(sample_areas(samples, samples.evaluate(mesh.points)).sum(), area, 1e-12 * area);
}

TEST(SurfaceSamples, RefusesGridsOutOfRange) {
  const SurfacePatches patches(Topology(cube()), Scheme{});
  EXPECT_THROW(SurfaceSamples(patches, GridSamples{0}), Error);
  EXPECT_THROW(SurfaceSamples(patches, GridSamples{65}), Error);
}

}  // namespace
}  // namespace batten
