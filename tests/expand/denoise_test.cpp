#include "batten/expand/denoise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "batten/error.h"
#include "batten/expand/crease_corners.h"
#include "batten/expand/strength.h"
#include "batten/expand/volume.h"
#include "batten/limit/limit_matrix.h"
#include "batten/parallel/parallel.h"
#include "batten/refine/refinement.h"
#include "support/schemes.h"
#include "support/shapes.h"

namespace batten {
namespace {

/// Normal noise on each coordinate, in shares of the mean edge length. Returns the deviation.
double add_noise(Mesh& mesh, double share, unsigned seed) {
  const Topology topology(mesh);
  double length = 0.0;
  for (Index e = 0; e < topology.edge_count(); ++e) {
    const Index h = topology.edge_half_edge(e);
    length += (mesh.points.row(topology.origin(h)) - mesh.points.row(topology.destination(h))).norm();
  }
  const double deviation = share * length / topology.edge_count();
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, deviation);
  for (double& coordinate : mesh.points.reshaped()) coordinate += normal(random);
  return deviation;
}

/// Root mean square of the distances from torus(around, across)'s surface.
double torus_error(const Points& points) {
  double sum = 0.0;
  for (Index v = 0; v < points.rows(); ++v) {
    const double from_axis = std::hypot(points(v, 0), points(v, 1)) - 1.0;
    const double distance = std::hypot(from_axis, points(v, 2)) - 0.4;
    sum += distance * distance;
  }
  return std::sqrt(sum / static_cast<double>(points.rows()));
}

/// [-1, 1]^3 with n by n squares a side.
Mesh fine_cube(int levels) {
  Mesh mesh = cube();
  for (Index v = 0; v < 8; ++v) mesh.corners.push_back({v, 10.0});
  const Topology topology(mesh);
  for (Index e = 0; e < topology.edge_count(); ++e) {
    const Index h = topology.edge_half_edge(e);
    mesh.creases.push_back({topology.origin(h), topology.destination(h), 10.0});
  }
  const Topology creased(mesh);
  const RefinedSurface refined = refine(creased, {}, mesh.points, levels);
  Mesh fine = mesh_from_topology(refined.topology);
  fine.points = refined.values;
  fine.creases.clear();
  fine.corners.clear();
  return fine;
}

/// How many coordinates of a point are at the cube's sides: 2 on an edge, 3 at a corner.
int sides_of(const Points& points, Index v) {
  int sides = 0;
  for (int c = 0; c < 3; ++c) sides += std::abs(points(v, c)) > 1.0 - 1e-9 ? 1 : 0;
  return sides;
}

/// A wave along one direction of a regular torus, S edges long, is an eigenvector.
TEST(Strength, IsThatOfWavesOnARegularMesh) {
  const Index around = 24;
  const Mesh quads = torus(around, 5);
  const Mesh triangles = test::triangle_torus(around, 5);
  for (const double edges : {2.0, 3.0, 6.0, 24.0}) {
    Values wave(quads.vertex_count(), 1);
    for (Index v = 0; v < wave.rows(); ++v) wave(v, 0) = std::cos(2.0 * std::numbers::pi * (v / 5) / edges);
    const auto left = [&](const Mesh& mesh, const Scheme& scheme) {
      const Topology topology(mesh);
      return MeshSeries(topology, scheme).remainder(wave, 1);
    };
    const double of_quads = wave_remainder(SchemeKind::CatmullClark, SeriesMatrix::Limit, edges);
    EXPECT_LT((left(quads, test::kCatmullClark) - of_quads * wave).cwiseAbs().maxCoeff(), 1e-14) << edges;
  }
  // On triangles along the edges the neighbours are at 1, 1/2 and 1/2 of the wave: two rows of a grid one edge high.
  for (const double edges : {2.0, 3.0, 6.0, 8.0}) {
    const double phase = 2.0 * std::numbers::pi / edges;
    const double a =
        0.5 + (2.0 * std::cos(phase) + 4.0 * std::cos(0.5 * phase)) / 12.0;  // (w v + sum e)/(w + 6), w = 6
    EXPECT_NEAR(wave_remainder(SchemeKind::Loop, SeriesMatrix::Limit, edges), 1.0 - a, 1e-15);
  }
}

TEST(Strength, PassesHalveTheBumpsTheyAreAskedFor) {
  for (const SchemeKind kind : {SchemeKind::CatmullClark, SchemeKind::Loop}) {
    for (const SeriesMatrix matrix : {SeriesMatrix::Limit, SeriesMatrix::Cotangent}) {
      for (const int m : {0, 2}) {
        for (const double edges : {2.0, 2.8, 5.0, 9.0}) {
          const int passes = passes_for(kind, matrix, m, edges);
          const double lost = std::pow(wave_remainder(kind, matrix, edges), m + 1);
          EXPECT_LE(std::pow(1.0 - lost, passes), 0.5 + 1e-9);
          if (passes > 1) {
            EXPECT_GT(std::pow(1.0 - lost, passes - 1), 0.5);
          }
          EXPECT_GE(halved_wavelength(kind, matrix, m, passes), edges - 1e-6);
        }
      }
    }
  }
  EXPECT_THROW(passes_for(SchemeKind::Loop, SeriesMatrix::Limit, 2, 1.9), Error);
  EXPECT_THROW(passes_for(SchemeKind::Loop, SeriesMatrix::Limit, 9, 900.0), Error);
}

/// A median of some thousand numbers is right to about two per cent; the shape adds the rest.
TEST(Noise, IsMeasuredToAFewPerCent) {
  for (const bool triangles : {false, true}) {
    for (const double share : {0.03, 0.1, 0.4}) {
      Mesh mesh = triangles ? test::triangle_torus(120, 60) : torus(120, 60);
      const double deviation = add_noise(mesh, share, 5);
      const DenoiseResult result = denoise(mesh, triangles ? test::kLoop : test::kCatmullClark);
      EXPECT_NEAR(result.noise.deviation, deviation, 0.07 * deviation) << triangles << " " << share;
    }
  }
}

TEST(Noise, IsNotWhatASmoothShapeIsMadeOf) {
  EXPECT_LT(denoise(torus(120, 60), test::kCatmullClark).noise.deviation, 1e-6);
}

/// A sixth of the vertices of this cube lie next to its edges; the root mean square would be ten times too large.
TEST(Noise, IsNotWhatSharpEdgesAreMadeOf) {
  Mesh mesh = fine_cube(5);
  const double deviation = add_noise(mesh, 0.05, 2);
  EXPECT_NEAR(denoise(mesh, test::kCatmullClark).noise.deviation, deviation, 0.2 * deviation);
}

/// Compared with the best of all passes, which the known shape determines.
TEST(Denoise, ChoosesPassesNearlyAsGoodAsTheBest) {
  for (const bool triangles : {false, true}) {
    for (const SeriesMatrix matrix : {SeriesMatrix::Limit, SeriesMatrix::Cotangent}) {
      Mesh mesh = triangles ? test::triangle_torus(60, 30) : torus(60, 30);
      const Scheme scheme = triangles ? test::kLoop : test::kCatmullClark;
      add_noise(mesh, 0.2, 8);
      DenoiseOptions options;
      options.automatic = true;
      options.matrix = matrix;
      const double chosen = torus_error(denoise(mesh, scheme, options).points);
      options.automatic = false;
      double best = torus_error(mesh.points);
      EXPECT_LT(chosen, 0.3 * best);
      for (options.m = 0; options.m <= 2; ++options.m) {
        for (options.passes = 1; options.passes < 200; options.passes += 1 + options.passes / 4)
          best = std::min(best, torus_error(denoise(mesh, scheme, options).points));
      }
      EXPECT_LT(chosen, 1.25 * best);
    }
  }
}

TEST(Denoise, LeavesASmoothShapeNearlyAlone) {
  DenoiseOptions options;
  options.automatic = true;
  const Mesh mesh = torus(80, 40);
  const DenoiseResult result = denoise(mesh, test::kCatmullClark, options);
  EXPECT_LT(result.most_moved, 1e-6);
}

TEST(Denoise, DoesAsTheSeriesDoes) {
  Mesh mesh = test::jittered(torus(20, 10), 0.02, 2);
  DenoiseOptions options;
  options.m = 1;
  options.passes = 6;
  const DenoiseResult result = denoise(mesh, test::kCatmullClark, options);
  const Topology topology(mesh);
  const Values expected = MeshSeries(topology, test::kCatmullClark).smooth(mesh.points, 1, 6);
  EXPECT_TRUE((result.points.array() == expected.array()).all());
  EXPECT_NEAR(result.moved, std::sqrt((expected - mesh.points).squaredNorm() / mesh.vertex_count()), 1e-15);
  EXPECT_EQ(result.most_moved, (expected - mesh.points).rowwise().norm().maxCoeff());
}

/// A sphere has every point at one distance from its middle, so that scaling brings its radius back too.
TEST(Denoise, KeepsTheVolumeOfEachComponent) {
  Mesh mesh = icosahedron();
  const Mesh other = dodecahedron();
  for (Index f = 0; f < other.face_count(); ++f) {
    for (Index i = other.face_offsets[f]; i < other.face_offsets[f + 1]; ++i)
      mesh.face_vertices.push_back(other.face_vertices[i] + 12);
    mesh.face_offsets.push_back(static_cast<Index>(mesh.face_vertices.size()));
  }
  const Points first = mesh.points;
  mesh.points.resize(32, 3);
  mesh.points.topRows(12) = first;
  mesh.points.bottomRows(20) = other.points.rowwise() + Eigen::RowVector3d(7.0, 0.0, 0.0);
  DenoiseOptions options;
  options.passes = 3;
  EXPECT_LT(denoise(mesh, test::kCatmullClark, options).volume_after,
            0.9 * denoise(mesh, test::kCatmullClark, options).volume_before);
  options.keep_volume = true;
  const DenoiseResult result = denoise(mesh, test::kCatmullClark, options);
  EXPECT_EQ(result.closed_components, 2);
  EXPECT_EQ(result.scaled_components, 2);
  EXPECT_NEAR(result.volume_after, result.volume_before, 1e-12 * result.volume_before);
  EXPECT_LT((result.points.topRows(12) - first).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((result.points.bottomRows(20) - mesh.points.bottomRows(20)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Denoise, TheVolumeOfACubeIsEight) {
  Mesh mesh = fine_cube(2);
  mesh.points.rowwise() += Eigen::RowVector3d(1e6, -2e6, 0.0);
  const Topology topology(mesh);
  EXPECT_NEAR(component_volumes(topology, mesh.points).sum(), 8.0, 1e-8);
  EXPECT_EQ(component_volumes(Topology(test::without_face(mesh, 3)), mesh.points).closed_count(), 0);
}

/// All edges of the cube and no others, at a noise that turns faces by 15 degrees.
TEST(Features, AreFoundUnderNoise) {
  const Mesh clean = fine_cube(4);
  Mesh mesh = clean;
  add_noise(mesh, 0.1, 4);
  const std::vector<Crease> found = find_features(Topology(mesh), mesh.points);
  EXPECT_EQ(found.size(), 12U * 16U);
  for (const Crease& crease : found) {
    EXPECT_GE(sides_of(clean.points, crease.a), 2);
    EXPECT_GE(sides_of(clean.points, crease.b), 2);
  }
}

TEST(Features, AreNotFoundWhereThereAreNone) {
  Mesh mesh = torus(60, 30);
  add_noise(mesh, 0.15, 4);
  EXPECT_TRUE(find_features(Topology(mesh), mesh.points).empty());
}

TEST(Denoise, KeepsFeaturesSharp) {
  const Mesh clean = fine_cube(4);
  Mesh mesh = clean;
  add_noise(mesh, 0.1, 4);
  DenoiseOptions options;
  options.passes = 30;
  // Distances across the sides only. Noise within a side does not count.
  const auto error = [&](const Points& points) {
    double sum = 0.0;
    for (Index v = 0; v < clean.vertex_count(); ++v) {
      for (int c = 0; c < 3; ++c) {
        if (std::abs(clean.points(v, c)) > 1.0 - 1e-9) sum += std::pow(points(v, c) - clean.points(v, c), 2);
      }
    }
    return std::sqrt(sum / clean.vertex_count());
  };
  const double blunt = error(denoise(mesh, test::kCatmullClark, options).points);
  options.features = true;
  const DenoiseResult result = denoise(mesh, test::kCatmullClark, options);
  EXPECT_LT(error(result.points), 0.6 * error(mesh.points));
  EXPECT_LT(error(result.points), 0.4 * blunt);
  // The corners go where their three sides meet.
  double before = 0.0;
  double after = 0.0;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (sides_of(clean.points, v) != 3) continue;
    before += (mesh.points.row(v) - clean.points.row(v)).squaredNorm();
    after += (result.points.row(v) - clean.points.row(v)).squaredNorm();
  }
  EXPECT_LT(after, 0.5 * before);
}

/// Noise that turns faces by 40 degrees and more: the angle of one edge tells nothing.
TEST(Features, AreFoundUnderStrongNoise) {
  const Mesh clean = fine_cube(4);
  for (const double share : {0.2, 0.3}) {
    Mesh mesh = clean;
    add_noise(mesh, share, 4);
    std::size_t right = 0;
    const std::vector<Crease> found = find_features(Topology(mesh), mesh.points);
    for (const Crease& crease : found) {
      right += sides_of(clean.points, crease.a) >= 2 && sides_of(clean.points, crease.b) >= 2 ? 1 : 0;
    }
    EXPECT_GT(right, 12U * 16U * 9 / 10) << share;
    EXPECT_LT(found.size() - right, 12U * 16U / 10) << share;
  }
}

TEST(Features, AreNotFoundInStrongNoiseAlone) {
  Mesh mesh = torus(80, 40);
  add_noise(mesh, 0.4, 4);
  EXPECT_LT(find_features(Topology(mesh), mesh.points).size(), 80U);
}

TEST(Denoise, FeaturesDoNoHarm) {
  for (const double share : {0.05, 0.1, 0.2, 0.4}) {
    Mesh mesh = torus(80, 40);
    add_noise(mesh, share, 7);
    DenoiseOptions options;
    options.automatic = true;
    const double without = torus_error(denoise(mesh, test::kCatmullClark, options).points);
    options.features = true;
    EXPECT_LE(torus_error(denoise(mesh, test::kCatmullClark, options).points), 1.02 * without) << share;
  }
}

/// Ridges of 28 degrees are no edges here, and the smoothing that suits the edges of 90 would flatten them.
TEST(Denoise, FeaturesMoveNoVertexFartherThanNoiseExplains) {
  Mesh mesh = fine_cube(4);
  mesh.points.col(2) += 0.25 * mesh.points.col(0).cwiseAbs();
  add_noise(mesh, 0.05, 3);
  DenoiseOptions options;
  options.automatic = true;
  const DenoiseResult plain = denoise(mesh, test::kCatmullClark, options);
  options.features = true;
  const DenoiseResult result = denoise(mesh, test::kCatmullClark, options);
  EXPECT_GT(result.features.size(), 100U);
  const Values normals = limit_normals(Topology(mesh), test::kCatmullClark, mesh.points).vertices;
  const auto moved = [&](const Points& points, Index v) {
    return std::abs(normals.row(v).dot(points.row(v) - mesh.points.row(v)));
  };
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    EXPECT_LE(moved(result.points, v), std::max(2.5 * plain.noise.deviation, moved(plain.points, v)) + 1e-12) << v;
  }
}

/// In a plane nothing but the place to hold tells where along it a vertex belongs.
TEST(CornerPlaces, HoldTheGivenPlaceAlongAPlane) {
  const Mesh mesh = grid(6, 6);
  const Topology topology(mesh);
  Points noisy = mesh.points;
  noisy.rowwise() += Eigen::RowVector3d(0.2, -0.1, 0.3);
  const Points places = corner_places(topology, {24}, mesh.points, noisy, mesh.points, 1.0);
  EXPECT_LT((places.row(0) - mesh.points.row(24)).norm(), 1e-12);
  EXPECT_EQ((corner_places(topology, {24}, mesh.points, noisy, mesh.points, 0.1).row(0) - noisy.row(24)).norm(), 0.0);
}

TEST(Denoise, KeepsTheBoundaryWhenAsked) {
  Mesh mesh = test::jittered(grid(12, 12), 0.05, 1);
  const Topology topology(mesh);
  DenoiseOptions options;
  const auto boundary_moved = [&](const DenoiseResult& result) {
    double most = 0.0;
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      if (topology.is_boundary_vertex(v)) most = std::max(most, (result.points.row(v) - mesh.points.row(v)).norm());
    }
    return most;
  };
  EXPECT_GT(boundary_moved(denoise(mesh, test::kCatmullClark, options)), 0.01);
  options.keep_boundary = true;
  const DenoiseResult kept = denoise(mesh, test::kCatmullClark, options);
  EXPECT_EQ(boundary_moved(kept), 0.0);
  EXPECT_GT(kept.moved, 0.01);
}

TEST(Denoise, ThreadsDoNotChangeABit) {
  Mesh mesh = torus(150, 80);
  add_noise(mesh, 0.1, 1);
  DenoiseOptions options;
  options.automatic = true;
  options.features = true;
  options.keep_volume = true;
  const DenoiseResult all = denoise(mesh, test::kCatmullClark, options);
  const ThreadLimit limit(1);
  const DenoiseResult one = denoise(mesh, test::kCatmullClark, options);
  EXPECT_TRUE((all.points.array() == one.points.array()).all());
  EXPECT_EQ(all.noise.deviation, one.noise.deviation);
  EXPECT_EQ(all.removed, one.removed);
}

TEST(Denoise, TakesEverySample) {
  test::for_each_sample([](const Mesh& mesh, const Scheme& scheme, const std::string& name) {
    SCOPED_TRACE(name);
    DenoiseOptions options;
    options.automatic = true;
    options.features = true;
    options.keep_volume = true;
    for (const SeriesMatrix matrix : {SeriesMatrix::Limit, SeriesMatrix::Cotangent}) {
      options.matrix = matrix;
      EXPECT_TRUE(denoise(mesh, scheme, options).points.allFinite());
    }
  });
}

TEST(Denoise, RefusesWhatMakesNoSense) {
  DenoiseOptions options;
  options.passes = -1;
  EXPECT_THROW(denoise(cube(), test::kCatmullClark, options), Error);
  options = {};
  options.m = -1;
  EXPECT_THROW(denoise(cube(), test::kCatmullClark, options), Error);
  options = {};
  options.features = true;
  options.feature_options.degrees = 180.0;
  EXPECT_THROW(denoise(cube(), test::kCatmullClark, options), Error);
  EXPECT_THROW(denoise(cube(), test::kLoop), Error);
}

}  // namespace
}  // namespace batten
