/// \file Adaptive tessellation to a chord tolerance: faces per second, and how many faces the tolerance needs.
#include <benchmark/benchmark.h>

#include "batten/adaptive/adaptive.h"
#include "batten/mesh/primitives.h"
#include "batten/parallel/threads.h"

namespace {

using batten::AdaptiveOptions;
using batten::FaceKind;
using batten::Mesh;

/// The meshes are a torus of quads, which is regular, and an icosahedron's quads, each of which has an extraordinary
/// vertex.
void tessellate(benchmark::State& state, const Mesh& mesh, FaceKind faces, double fraction) {
  const batten::ThreadLimit limit(1);
  const batten::Topology topology(mesh);
  AdaptiveOptions options;
  options.chord = fraction * batten::bounding_diagonal(mesh.points);
  options.faces = faces;
  double count = 0.0;
  for (auto _ : state) {
    const batten::AdaptiveMesh result = batten::tessellate_adaptively(topology, {}, mesh.points, options);
    count = result.mesh.face_count();
    benchmark::DoNotOptimize(result.mesh.points.data());
  }
  state.counters["faces"] = count;
  state.counters["faces/s"] =
      benchmark::Counter(count, benchmark::Counter::kIsIterationInvariantRate, benchmark::Counter::kIs1000);
}

BENCHMARK_CAPTURE(tessellate, torus_triangles, batten::torus(64, 32), FaceKind::Triangles, 1e-6)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tessellate, torus_quads, batten::torus(64, 32), FaceKind::Quads, 1e-6)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tessellate, icosahedron_triangles, batten::icosahedron(), FaceKind::Triangles, 1e-6)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tessellate, icosahedron_quads, batten::icosahedron(), FaceKind::Quads, 1e-6)
    ->Unit(benchmark::kMillisecond);

}  // namespace
