#include "batten/expand/surface_noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "batten/error.h"
#include "batten/expand/solid_noise.h"
#include "batten/interpolate/interpolator.h"
#include "batten/limit/limit_matrix.h"
#include "batten/parallel/parallel.h"
#include "batten/refine/refinement.h"
#include "batten/tessellate/surface_mesh.h"
#include "io/io_test_tools.h"
#include "support/schemes.h"
#include "support/shapes.h"

namespace batten {
namespace {

/// With two stray vertices, so that the bounding box, and with it the noise, is the same at all levels.
Mesh boxed(Mesh mesh) {
  const Index count = mesh.vertex_count();
  mesh.points.conservativeResize(count + 2, 3);
  mesh.points.row(count).setConstant(-9.0);
  mesh.points.row(count + 1).setConstant(9.0);
  return mesh;
}

/// Closed, open, of mixed faces, with a singular interpolation (the cube), creased.
std::vector<Mesh> boxed_shapes() {
  std::vector<Mesh> all{torus(9, 7), grid(6, 5), cube(), test::bipyramid(5), test::annulus(8)};
  all.push_back(torus(9, 7));
  all.back().creases = {{0, 1, 10.0}, {1, 2, 10.0}, {2, 3, 1.5}};
  all.back().corners = {{1, 10.0}};
  for (Mesh& mesh : all) mesh = boxed(mesh);
  return all;
}

/// Octaves of frequency 6, 12, ...: those two are sampled at levels 0 and 1 or coarser on the shapes.
NoiseOptions octaves(int count) { return {7, 6.0, count, 1.0, Eigen::Vector3d::Ones()}; }

Values noise_at(const Topology& topology, const Scheme& scheme, ConstValuesRef points, int levels,
                const NoiseOptions& noise) {
  return SurfaceNoise(topology, scheme, levels).values(points, std::span(&noise, 1));
}

/// The surface through `numbers`, at the vertices of `levels` refinements.
Values through(const Topology& topology, const Scheme& scheme, const Values& numbers, int levels) {
  const Interpolant interpolant = Interpolator(topology, scheme).solve(numbers);
  const int done = interpolant.topology.vertex_count() > topology.vertex_count() ? 1 : 0;
  const RefinedSurface surface = refine(interpolant.topology, interpolant.scheme, interpolant.control, levels - done);
  return LimitMatrix(surface.topology, scheme).apply(surface.values);
}

TEST(SolidNoise, HasTheValuesOfAnIndependentProgram) {
  EXPECT_NEAR(solid_noise({0.3, 0.7, -1.2}, 7), 0.0034832474438529462, 1e-14);
  EXPECT_NEAR(solid_noise({-5.5, 100.25, 3.0}, 12345), 2.2867142146582413, 1e-14);
  EXPECT_NEAR(solid_noise({0.0, 0.0, 0.0}, 0), 1.6193775664158119, 1e-14);
}

TEST(SolidNoise, HasMeanZeroAndVarianceOne) {
  // 40,000 seeds: the mean of as many independent numbers of variance 1 strays by 0.005, that of the squares by 0.01.
  const Eigen::Vector3d point(0.25, -3.6, 17.9);
  double sum = 0.0;
  double squares = 0.0;
  constexpr int kSeeds = 40000;
  for (std::uint32_t seed = 0; seed < kSeeds; ++seed) {
    const double value = solid_noise(point, seed);
    sum += value;
    squares += value * value;
  }
  EXPECT_NEAR(sum / kSeeds, 0.0, 0.025);
  EXPECT_NEAR(squares / kSeeds, 1.0, 0.05);
}

TEST(SolidNoise, IsSmoothAcrossTheSidesOfItsCells) {
  const double step = 1e-3;
  for (const double side : {-1.0, 0.0, 1.0}) {
    const auto at = [&](double x) { return solid_noise({side + x, 0.4, 0.7}, 3); };
    // The second derivative is continuous: third differences over the side are of the step's third power.
    EXPECT_NEAR(at(2 * step) - 3.0 * at(step) + 3.0 * at(0.0) - at(-step), 0.0, 1e-6);
  }
}

TEST(SurfaceNoise, PassesThroughTheRandomNumbersOfItsLevel) {
  for (const Mesh& mesh : boxed_shapes()) {
    const Topology topology(mesh);
    const Mesh surface = surface_mesh(topology, test::kCatmullClark, mesh, 2);
    const Values noise = noise_at(topology, test::kCatmullClark, surface.points, 2, octaves(1));
    const Values numbers =
        noise_at(topology, test::kCatmullClark, surface.points.topRows(mesh.vertex_count()), 0, octaves(1));
    // The interpolator's 1e-10 of the numbers' range, which is below 10.
    EXPECT_LT((noise.topRows(numbers.rows()) - numbers).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_GT(numbers.cwiseAbs().maxCoeff(), 0.1);
  }
}

TEST(SurfaceNoise, AddsEachOctavesOwnSurface) {
  for (const Mesh& mesh : boxed_shapes()) {
    const Topology topology(mesh);
    const Mesh surface = surface_mesh(topology, test::kCatmullClark, mesh, 3);
    const Refinement step(topology, test::kCatmullClark);
    const Index coarse = mesh.vertex_count();
    const Index fine = step.child().vertex_count();
    const Values first = noise_at(topology, test::kCatmullClark, surface.points.topRows(coarse), 0, octaves(1));
    const Values both = noise_at(step.child(), test::kCatmullClark, surface.points.topRows(fine), 0, octaves(2));
    const Values fine_first = noise_at(step.child(), test::kCatmullClark, surface.points.topRows(fine), 0, octaves(1));
    const Values second = std::sqrt(2.0) * both - fine_first;
    const Values sum = through(topology, test::kCatmullClark, first, 3);
    const Values noise = noise_at(topology, test::kCatmullClark, surface.points, 3, octaves(2));
    // The octave of 12 is sampled at the coarsest level with edges of half its features.
    const Values at_coarse = (sum + through(topology, test::kCatmullClark, second.topRows(coarse), 3)) / std::sqrt(2.0);
    const Values at_fine = (sum + through(step.child(), test::kCatmullClark, second, 2)) / std::sqrt(2.0);
    EXPECT_LT(std::min((noise - at_coarse).cwiseAbs().maxCoeff(), (noise - at_fine).cwiseAbs().maxCoeff()), 1e-8);
  }
}

TEST(SurfaceNoise, DependsOnPlacesNotOnTheOrderOfVertices) {
  const Mesh mesh = torus(12, 9);
  Mesh turned = mesh;
  const Index count = mesh.vertex_count();
  for (Index v = 0; v < count; ++v) turned.points.row((v + 17) % count) = mesh.points.row(v);
  for (Index& v : turned.face_vertices) v = (v + 17) % count;
  const Topology topology(mesh);
  const Topology other(turned);
  const Values noise =
      noise_at(topology, test::kCatmullClark, surface_mesh(topology, test::kCatmullClark, mesh, 2).points, 2, {});
  const Values moved =
      noise_at(other, test::kCatmullClark, surface_mesh(other, test::kCatmullClark, turned, 2).points, 2, {});
  // Twice the interpolator's tolerance.
  for (Index v = 0; v < count; ++v) EXPECT_NEAR(noise(v, 0), moved((v + 17) % count, 0), 1e-8);
}

TEST(SurfaceNoise, HasTheSameBitsForAnyNumberOfThreads) {
  const Mesh mesh = test::triangle_torus(40, 30);
  const Topology topology(mesh);
  const Mesh surface = surface_mesh(topology, test::kLoop, mesh, 2);
  Values one;
  {
    const ThreadLimit limit(1);
    one = noise_at(topology, test::kLoop, surface.points, 2, {});
  }
  const ThreadLimit limit(7);
  const Values seven = noise_at(topology, test::kLoop, surface.points, 2, {});
  EXPECT_TRUE((one.array() == seven.array()).all());
  EXPECT_FALSE((one.array() == noise_at(topology, test::kLoop, surface.points, 2, {2}).array()).any());
}

TEST(SurfaceNoise, RefusesWhatItCannotUse) {
  const Mesh mesh = cube();
  const Topology topology(mesh);
  const SurfaceNoise noise(topology, test::kCatmullClark, 0);
  const NoiseOptions plain;
  io_tests::expect_error([&] { noise.values(mesh.points.topRows(7), std::span(&plain, 1)); }, ErrorCode::BadShape,
                         "8 vertices");
  NoiseOptions rough;
  rough.gain = 5.0;
  io_tests::expect_error([&] { noise.values(mesh.points, std::span(&rough, 1)); }, ErrorCode::BadArgument, "gain");
  Points wild = mesh.points;
  wild(3, 1) = std::nan("");
  io_tests::expect_error([&] { noise.values(wild, std::span(&plain, 1)); }, ErrorCode::NotFinite, "vertex 3");
  io_tests::expect_error([&] { SurfaceNoise(topology, test::kCatmullClark, -1); }, ErrorCode::BadArgument, "negative");
  io_tests::expect_error([&] { SurfaceNoise(topology, test::kLoop, 1); }, ErrorCode::NotTriangles, "");
}

}  // namespace
}  // namespace batten
