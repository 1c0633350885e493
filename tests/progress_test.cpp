/// Every operation that may take long reports its progress and can be cancelled.
#include <gtest/gtest.h>

#include <numeric>
#include <thread>

#include "batten/adaptive/adaptive.h"
#include "batten/expand/bands.h"
#include "batten/expand/denoise.h"
#include "batten/expand/mesh_series.h"
#include "batten/expand/morph_surface.h"
#include "batten/expand/resample.h"
#include "batten/expand/scheme_comparison.h"
#include "batten/expand/sharpen.h"
#include "batten/expand/texture.h"
#include "batten/interpolate/fair_interpolation.h"
#include "batten/interpolate/interpolated_mesh.h"
#include "batten/interpolate/interpolation_updates.h"
#include "batten/interpolate/local_normals.h"
#include "batten/interpolate/method_comparison.h"
#include "batten/limit/limit_matrix.h"
#include "batten/mesh/check.h"
#include "batten/mesh/discrete_curvature.h"
#include "batten/mesh/measures.h"
#include "batten/mesh/primitives.h"
#include "batten/mesh/repair.h"
#include "batten/mesh/triangulate.h"
#include "batten/nearest/nearest_point.h"
#include "batten/nearest/surface_distances.h"
#include "batten/refine/refinement.h"
#include "batten/surface/surface_weights.h"
#include "batten/tessellate/surface_mesh.h"
#include "batten/tessellate/tessellator.h"
#include "io/io_test_tools.h"
#include "support/shapes.h"

namespace batten {
namespace {

using Operation = std::function<void(const Progress&)>;

struct Named {
  const char* name;
  Operation run;
};

/// Flat sides of 256 quads each, with noise of a sixth of an edge.
Mesh noisy_cube() {
  Mesh sharp = cube();
  const Topology edges(sharp);
  for (Index e = 0; e < edges.edge_count(); ++e) {
    const Index h = edges.edge_half_edge(e);
    sharp.creases.push_back({edges.origin(h), edges.destination(h), kInfiniteSharpness});
  }
  const RefinedSurface fine = refine(Topology(sharp), Scheme(), sharp.points, 4);
  Mesh mesh = mesh_from_topology(fine.topology);
  mesh.points = fine.values;
  mesh.creases.clear();
  mesh.corners.clear();
  return test::jittered(mesh, edge_lengths(Topology(mesh), mesh.points).mean / 6.0, 5);
}

/// The operations, each on a mesh large enough for several blocks.
std::vector<Named> operations(const io_tests::TemporaryFolder& folder) {
  static const Mesh mesh = torus(150, 100);
  static const Topology topology(mesh);
  static const Mesh small = torus(48, 32);
  static const Topology small_topology(small);
  static const Scheme scheme;
  static const Interpolator interpolator(topology, scheme);
  std::vector<Named> all{
      {"topology", [](const Progress& progress) { Topology(mesh, progress); }},
      {"check", [](const Progress& progress) { check(mesh, 1, progress); }},
      {"repair", [](const Progress& progress) { repair(mesh, {}, progress); }},
      {"refine", [](const Progress& progress) { refine(topology, scheme, mesh.points, 2, progress); }},
      {"limit matrix", [](const Progress& progress) { LimitMatrix(topology, scheme, {}, progress); }},
      {"limit positions", [](const Progress& progress) { interpolator.limit_matrix().apply(mesh.points, progress); }},
      {"limit normals",
       [](const Progress& progress) { limit_normals(topology, scheme, mesh.points, LimitMasks::Exact, progress); }},
      {"nearest points, built",
       [](const Progress& progress) { NearestPoints(topology, scheme, mesh.points, progress); }},
      {"nearest points, moved",
       [](const Progress& progress) {
         static NearestPoints nearest(topology, scheme, mesh.points);
         nearest.set_control(2.0 * mesh.points, progress);
       }},
      {"nearest points, found",
       [](const Progress& progress) {
         static const NearestPoints nearest(topology, scheme, mesh.points);
         std::vector<NearestPoint> found(static_cast<std::size_t>(mesh.vertex_count()));
         nearest.nearest(mesh.points, found, progress);
       }},
      {"surface weights", [](const Progress& progress) { SurfaceWeights(topology, scheme, progress); }},
      {"limit surface", [](const Progress& progress) { LimitSurface(topology, scheme, mesh.points, progress); }},
      {"tessellation",
       [](const Progress& progress) {
         tessellate(small_topology, scheme, small.points, 3, {true, true}, progress);
       }},
      {"surface mesh", [](const Progress& progress) { surface_mesh(small_topology, scheme, small, 2, progress); }},
      {"surface mesh of a Butterfly",
       [](const Progress& progress) {
         static const Mesh triangles = triangulated(small);
         static const Topology connected(triangles);
         surface_mesh(connected, {SchemeKind::ModifiedButterfly}, triangles, 1, progress);
       }},
      {"distances",
       [](const Progress& progress) {
         measure_distances(small_topology, scheme, small.points, small.points, progress);
       }},
      {"methods compared",
       [](const Progress& progress) { compare_methods(small_topology, scheme, {}, small.points, progress); }},
      {"schemes compared",
       [](const Progress& progress) {
         static const Mesh triangles = triangulated(torus(15, 10));
         compare_schemes(Topology(triangles), scheme, triangles.points, 1, progress);
       }},
      {"discrete curvature",
       [](const Progress& progress) {
         const DiscreteCurvature curvature =
             discrete_curvature(topology, mesh.points, progress_within(progress, 0.0, 0.5));
         fairness(topology, mesh.points, curvature, progress_within(progress, 0.5, 1.0));
       }},
      {"normals turned",
       [](const Progress& progress) {
         const Values wanted = Eigen::RowVector3d(1.0, 2.0, 3.0).replicate(small.vertex_count(), 1);
         turn_normals(small_topology, scheme, small.points, wanted, {}, progress);
       }},
      {"interpolator", [](const Progress& progress) { Interpolator(topology, scheme, {}, progress); }},
      {"mesh series",
       [](const Progress& progress) {
         SeriesOptions options;
         options.shape = mesh.points;
         for (const SeriesMatrix matrix : {SeriesMatrix::Limit, SeriesMatrix::Cotangent}) {
           options.matrix = matrix;
           const double first = matrix == SeriesMatrix::Limit ? 0.0 : 0.5;
           const Progress half = progress_within(progress, first, first + 0.5);
           const MeshSeries series(topology, scheme, options, progress_within(half, 0.0, 0.5));
           series.smooth(mesh.points, 2, 20, progress_within(half, 0.5, 1.0));
         }
       }},
      {"denoise",
       [](const Progress& progress) {
         DenoiseOptions options;
         options.automatic = true;
         options.features = true;
         options.matrix = SeriesMatrix::Cotangent;
         denoise(mesh, scheme, options, progress);
       }},
      {"denoise with edges in noise",
       [](const Progress& progress) {
         static const Mesh noisy = noisy_cube();
         DenoiseOptions options;
         options.automatic = true;
         options.features = true;
         const DenoiseResult result = denoise(noisy, scheme, options, progress);
         EXPECT_GT(result.features.size() + static_cast<std::size_t>(result.features_left_out), 0U);
       }},
      {"sharpen", [](const Progress& progress) { sharpen(topology, scheme, mesh.points, {}, progress); }},
      {"bands",
       [](const Progress& progress) {
         static const MeshSeries series(topology, scheme);
         const std::vector<Band> bands = octave_bands(scheme.kind, SeriesMatrix::Limit, 3);
         equalize(series, mesh.points, bands, {1.0, 0.5, 1.0}, progress);
       }},
      {"adaptive",
       [](const Progress& progress) {
         AdaptiveOptions options;
         options.chord = 1e-3;
         options.angle = 5.0;
         tessellate_adaptively(topology, scheme, mesh.points, options, progress);
       }},
      {"solve", [](const Progress& progress) { interpolator.solve(mesh.points, progress); }},
      {"interpolation updates",
       [](const Progress& progress) { InterpolationUpdates(interpolator, mesh.points, progress); }},
      {"an update of everything",
       [](const Progress& progress) {
         InterpolationUpdates updates(interpolator, mesh.points);
         std::vector<Index> rows(static_cast<std::size_t>(mesh.vertex_count()));
         std::iota(rows.begin(), rows.end(), 0);
         updates.update(rows, 2.0 * mesh.points, progress);
       }},
      {"an update within rings",
       [](const Progress& progress) {
         InterpolationUpdates updates = InterpolationUpdates::from_control(interpolator, mesh.points);
         const Index vertex = 0;
         updates.update_within(20, {&vertex, 1}, 2.0 * mesh.points.row(vertex), progress);
       }},
      {"interpolate", [](const Progress& progress) { interpolate(mesh, {}, progress); }},
      {"interpolate fairly",
       [](const Progress& progress) { interpolate_fairly(topology, scheme, mesh.points, {}, progress); }},
      {"morph",
       [](const Progress& progress) {
         static const MeshSeries series(topology, scheme);
         Morph(series, mesh.points, 2.0 * mesh.points, {1, 2}, progress);
       }},
      {"morph sequence",
       [](const Progress& progress) {
         static const MeshSeries series(topology, scheme);
         morph_sequence(series, mesh.points, 2.0 * mesh.points, {}, progress);
       }},
      {"morph surface",
       [](const Progress& progress) {
         static const MeshSeries series(topology, scheme);
         static const Morph morph(series, mesh.points, 2.0 * mesh.points, {1, 1});
         morph_surface(topology, scheme, mesh, morph, 0, 2, 1.0, progress);
       }},
      {"resample",
       [](const Progress& progress) {
         static const Mesh other = torus(40, 30);
         static const Topology target(other);
         resample(target, scheme, 1.01 * other.points, target, scheme, other.points, 0.25, progress);
       }},
      {"texture", [](const Progress& progress) {
         textured_surface(topology, scheme, mesh, preset_texture(TexturePreset::Clouds), {1}, progress);
       }}};
  for (const char* name : {"m.obj", "m.ply", "m.off", "m.stl"}) {
    const std::string path = folder.path(name);
    all.push_back({"write", [path](const Progress& progress) { write_mesh(path, mesh, {}, progress); }});
    all.push_back({"read", [path](const Progress& progress) { read_mesh(path, "", progress); }});
  }
  return all;
}

TEST(LongWork, ReportsRisingFractionsOnTheCallersThread) {
  const io_tests::TemporaryFolder folder;
  for (const Named& operation : operations(folder)) {
    SCOPED_TRACE(operation.name);
    std::vector<double> fractions;
    operation.run([&, caller = std::this_thread::get_id()](double done) {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      fractions.push_back(done);
      return true;
    });
    ASSERT_FALSE(fractions.empty());
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    EXPECT_GE(fractions.front(), 0.0);
    EXPECT_LE(fractions.back(), 1.0);
  }
}

TEST(LongWork, StopsAtWhicheverReportItIsAskedTo) {
  const io_tests::TemporaryFolder folder;
  for (const Named& operation : operations(folder)) {
    SCOPED_TRACE(operation.name);
    int calls = 0;
    operation.run([&](double /*done*/) { return ++calls > 0; });
    for (int stop = 1; stop <= calls; stop += std::max(calls / 7, 1)) {
      int seen = 0;
      io_tests::expect_error([&] { operation.run([&](double /*done*/) { return ++seen != stop; }); },
                             ErrorCode::Cancelled, "cancelled");
      EXPECT_EQ(seen, stop);
    }
  }
}

TEST(LongWork, ACancelledWriteLeavesTheOldFileAndNothingElse) {
  const io_tests::TemporaryFolder folder;
  io_tests::make_file(folder.path("m.obj"), "# old\n");
  int calls = 0;
  const auto late = [&](double done) { return ++calls < 2 || done < 0.5; };
  io_tests::expect_error([&] { write_mesh(folder.path("m.obj"), torus(300, 200), {}, late); }, ErrorCode::Cancelled,
                         "");
  EXPECT_GT(calls, 1);
  EXPECT_EQ(io_tests::file_text(folder.path("m.obj")), "# old\n");
  EXPECT_EQ(folder.file_count(), 1);
}

TEST(LongWork, ACallbackChangesNoBit) {
  const Mesh mesh = torus(300, 200);
  const auto go_on = [](double /*done*/) { return true; };
  const Mesh watched = interpolate(mesh, {}, go_on).mesh;
  EXPECT_TRUE(io_tests::same_bits(watched.points, interpolate(mesh).mesh.points));
}

}  // namespace
}  // namespace batten
