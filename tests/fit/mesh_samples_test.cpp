#include "batten/fit/mesh_samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "batten/mesh/primitives.h"
#include "support/errors.h"

namespace batten {
namespace {

Index count_of(const MeshSamples& samples, SampleKind kind) {
  return static_cast<Index>(std::count(samples.kinds.begin(), samples.kinds.end(), kind));
}

TEST(MeshSamples, LieOnTheFacesWithTheirNormals) {
  const MeshSamples samples = sample_mesh(cube(), 600);
  ASSERT_EQ(samples.points.rows(), 600);
  Eigen::Array<int, 6, 1> per_face = Eigen::Array<int, 6, 1>::Zero();
  for (Index i = 0; i < 600; ++i) {
    EXPECT_NEAR(samples.points.row(i).cwiseAbs().maxCoeff(), 1.0, 1e-12);
    EXPECT_NEAR(samples.points.row(i).dot(samples.normals.row(i)), 1.0, 1e-12);
    ++per_face(samples.faces[i]);
  }
  EXPECT_EQ(per_face.minCoeff(), 100);
  EXPECT_EQ(per_face.maxCoeff(), 100);
}

/// A tenth of a square's sides: each of the 10 by 10 parts has 10 of 1,000 samples, up to the sequence's discrepancy.
TEST(MeshSamples, AreSpreadEvenly) {
  const MeshSamples samples = sample_mesh(grid(1, 1), 1000);
  Eigen::ArrayXXi counts = Eigen::ArrayXXi::Zero(10, 10);
  for (Index i = 0; i < 1000; ++i)
    ++counts(static_cast<int>(5.0 * (samples.points(i, 0) + 1.0)),
             static_cast<int>(5.0 * (samples.points(i, 1) + 1.0)));
  EXPECT_GE(counts.minCoeff(), 4);
  EXPECT_LE(counts.maxCoeff(), 16);
}

TEST(MeshSamples, MarkBoundariesAndCreases) {
  Mesh mesh = grid(4, 4);
  mesh.creases = {{6, 7, 10.0}, {7, 8, 0.5}};
  const MeshSamples samples = sample_mesh(mesh, 400);
  EXPECT_NEAR(samples.spacing, 0.1, 1e-12);
  EXPECT_EQ(count_of(samples, SampleKind::Face), 400);
  EXPECT_EQ(count_of(samples, SampleKind::Crease), 10);
  EXPECT_EQ(count_of(samples, SampleKind::Boundary), 80);
  for (std::size_t i = 0; i < samples.kinds.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (samples.kinds[i] == SampleKind::Face) continue;
    const bool boundary = samples.kinds[i] == SampleKind::Boundary;
    EXPECT_EQ(boundary ? samples.points.row(row).cwiseAbs().maxCoeff() : samples.points(row, 1), boundary ? 1.0 : -0.5);
  }
}

TEST(MeshSamples, TakeBentEdgesForCreasesWhereAsked) {
  MeshSampleOptions options;
  options.sharp_angle = 1.0;
  EXPECT_EQ(count_of(sample_mesh(cube(), 2400, options), SampleKind::Crease), 12 * 20);
  options.sharp_angle = 1.6;
  EXPECT_EQ(count_of(sample_mesh(cube(), 2400, options), SampleKind::Crease), 0);
}

TEST(MeshSamples, LeaveOutHoles) {
  Mesh mesh = cube();
  mesh.holes = {2};
  const MeshSamples samples = sample_mesh(mesh, 500);
  for (std::size_t i = 0; i < samples.kinds.size(); ++i) EXPECT_NE(samples.faces[i], 2);
}

TEST(MeshSamples, RefuseWhatHasNoArea) {
  Mesh mesh = cube();
  test::expect_error([&] { sample_mesh(mesh, 0); }, ErrorCode::BadArgument, "places");
  mesh.points.setZero();
  test::expect_error([&] { sample_mesh(mesh, 10); }, ErrorCode::BadArgument, "area");
  test::expect_error([] { sample_mesh({}, 10); }, ErrorCode::BadArgument, "area");
}

/// A file of points with normals of length 2, and a mesh.
TEST(CloudOfMesh, TakesAFilesPointsAndNormalsOrSamplesItsFaces) {
  Mesh file;
  file.points = cube().points;
  EXPECT_EQ(cloud_of_mesh(file, 100).points, file.points);
  EXPECT_EQ(cloud_of_mesh(file, 100).normals.rows(), 0);
  Attribute normal{"normal", 2.0 * file.points.rowwise().normalized(), {}};
  file.attributes = {normal};
  EXPECT_LT((cloud_of_mesh(file, 100).normals - file.points.rowwise().normalized()).norm(), 1e-12);
  const PointCloud sampled = cloud_of_mesh(cube(), 2000);
  EXPECT_EQ(sampled.points.rows(), 24000);
  EXPECT_EQ(sampled.normals.rows(), 24000);
  EXPECT_NEAR(sampled.points.rowwise().lpNorm<Eigen::Infinity>().minCoeff(), 1.0, 1e-12);
  EXPECT_EQ(sample_count(1), 10000);
  EXPECT_EQ(sample_count(10000000), 199992);
}

}  // namespace
}  // namespace batten
