#include "batten/expand/bands.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "batten/error.h"
#include "batten/refine/refinement.h"
#include "support/shapes.h"

namespace batten {
namespace {

TEST(Bands, AddUpToTheValues) {
  test::for_each_sample([](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    SCOPED_TRACE(name);
    const Topology topology(mesh);
    for (const SeriesMatrix matrix : {SeriesMatrix::Limit, SeriesMatrix::Cotangent}) {
      SeriesOptions options;
      options.matrix = matrix;
      options.shape = mesh.points;
      const MeshSeries series(topology, scheme, options);
      Values sum = Values::Zero(mesh.vertex_count(), 3);
      std::size_t seen = 0;
      for_each_band(series, mesh.points, octave_bands(scheme.kind, matrix, 5), [&](std::size_t j, const Values& band) {
        EXPECT_EQ(j, seen++);
        sum += band;
      });
      EXPECT_EQ(seen, 5U);
      EXPECT_LT((sum - mesh.points).cwiseAbs().maxCoeff(), 1e-13);
    }
  });
}

/// A wave of S edges along a torus is an eigenvector: bands 1 and 2 share one of 4 edges half and half, and so on.
TEST(Bands, HaveTheWavesOfTheirOctave) {
  const Index around = 64;
  const Mesh mesh = torus(around, 5);
  const Topology topology(mesh);
  const MeshSeries series(topology, {});
  const std::vector<Band> bands = octave_bands(SchemeKind::CatmullClark, SeriesMatrix::Limit, 4);
  const auto shares = [&](double edges) {
    Values wave(mesh.vertex_count(), 1);
    for (Index v = 0; v < wave.rows(); ++v) wave(v, 0) = std::cos(2.0 * std::numbers::pi * (v / 5) / edges);
    std::vector<double> found;
    for_each_band(series, wave, bands, [&](std::size_t, const Values& band) {
      found.push_back(band.cwiseProduct(wave).sum() / wave.squaredNorm());
      EXPECT_LT((band - found.back() * wave).cwiseAbs().maxCoeff(), 1e-13);
    });
    return found;
  };
  EXPECT_GT(shares(2.0)[0], 0.85);
  EXPECT_NEAR(shares(8.0)[0] + shares(8.0)[1], 0.5, 0.05);  // at the limit of two bands, to a whole pass
  EXPECT_NEAR(shares(16.0)[3], 0.5, 0.01);
  EXPECT_GT(shares(64.0)[3], 0.94);
}

TEST(Bands, GainsOfOneLeaveEveryBit) {
  const Mesh mesh = test::jittered(torus(20, 12), 0.03, 1);
  const Topology topology(mesh);
  const MeshSeries series(topology, {});
  const std::vector<Band> bands = octave_bands(SchemeKind::CatmullClark, SeriesMatrix::Limit, 4);
  const Equalized same = equalize(series, mesh.points, bands, {1.0, 1.0, 1.0, 1.0});
  EXPECT_TRUE((same.values.array() == mesh.points.array()).all());
  std::vector<Values> parts;
  for_each_band(series, mesh.points, bands, [&](std::size_t, const Values& band) { parts.push_back(band); });
  for (int j = 0; j < 3; ++j) EXPECT_NEAR(same.energies[j], parts[j].squaredNorm() / mesh.vertex_count(), 1e-15);
  const Equalized mixed = equalize(series, mesh.points, bands, {0.0, 3.0, 1.0, 2.0});
  const Eigen::RowVector3d mean = parts[3].colwise().mean();
  const Values expected = Values(3.0 * parts[1] + parts[2] + 2.0 * parts[3]).rowwise() - mean;
  EXPECT_LT((mixed.values - expected).cwiseAbs().maxCoeff(), 1e-13);
}

/// Dropping all bands but the last is smoothing; kept vertices stay, since their bands are empty.
TEST(Bands, LeaveKeptVertices) {
  const Mesh mesh = test::jittered(grid(12, 12), 0.05, 1);
  const Topology topology(mesh);
  SeriesOptions options;
  for (Index v = 0; v < mesh.vertex_count(); ++v) options.kept.push_back(topology.is_boundary_vertex(v) ? 1 : 0);
  const MeshSeries series(topology, {}, options);
  const Equalized smooth =
      equalize(series, mesh.points, octave_bands(SchemeKind::CatmullClark, SeriesMatrix::Limit, 3), {0.0, 0.0, 1.0});
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (series.is_kept(v)) {
      EXPECT_LT((smooth.values.row(v) - mesh.points.row(v)).norm(), 1e-15);
    }
  }
  EXPECT_GT((smooth.values - mesh.points).cwiseAbs().maxCoeff(), 0.02);
}

TEST(Bands, RefuseWhatMakesNoSense) {
  const Mesh mesh = cube();
  const Topology topology(mesh);
  const MeshSeries series(topology, {});
  EXPECT_THROW(octave_bands(SchemeKind::Loop, SeriesMatrix::Limit, 1), Error);
  EXPECT_THROW(octave_bands(SchemeKind::Loop, SeriesMatrix::Limit, 13), Error);
  std::vector<Band> bands = octave_bands(SchemeKind::CatmullClark, SeriesMatrix::Limit, 3);
  EXPECT_THROW(equalize(series, mesh.points, bands, {1.0, 1.0}), Error);
  EXPECT_THROW(equalize(series, mesh.points, bands, {1.0, std::nan(""), 1.0}), Error);
  EXPECT_THROW(equalize(series, Values::Zero(7, 3), bands, {1.0, 1.0, 1.0}), Error);
  std::swap(bands[0], bands[1]);
  EXPECT_THROW(equalize(series, mesh.points, bands, {1.0, 1.0, 1.0}), Error);
}

}  // namespace
}  // namespace batten
