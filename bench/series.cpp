/// The mesh series: smoothing beside whole sweeps over the mesh, and the bytes that the sweeps must move.
#include <ctime>

#include "batten/expand/mesh_series.h"
#include "batten/limit/limit_matrix.h"
#include "batten/mesh/primitives.h"
#include "bench/bench.h"

namespace batten::bench {

namespace {

constexpr int kM = 2;
constexpr int kPasses = 4;

/// The least number of bytes that a whole sweep of A moves for each vertex: the indices of eight neighbours, a row in,
/// a row out.
constexpr double kSweepBytes = 8.0 * sizeof(Index) + 2.0 * 3.0 * sizeof(double);

Values sweeps(const LimitMatrix& matrix, Values x) {
  for (int pass = 0; pass < kPasses; ++pass) {
    Values left = x;
    for (int i = 0; i <= kM; ++i) left -= matrix.apply(left);
    x -= left;
  }
  return x;
}

}  // namespace

std::string series_section() {
  MarkdownTable table({"mesh", "vertices", "build, ms", "denoise, ms", "processor, ms",
                       "cotangent weights: build + denoise, ms", "bytes of sweeps, GB/s that this would be",
                       "double-precision sweeps, ms"});
  for (const Index vertices : {32'000, 512'000, 2'000'000}) {
    const Subject mesh = subject(vertices);
    const MeshSeries series(mesh.topology, mesh.scheme);
    const LimitMatrix matrix(mesh.topology, mesh.scheme);
    SeriesOptions by_shape;
    by_shape.matrix = SeriesMatrix::Cotangent;
    by_shape.shape = mesh.targets;
    const MeshSeries cotangent(mesh.topology, mesh.scheme, by_shape);
    const std::vector<double> seconds = in_turn(
        {[&] { const MeshSeries again(mesh.topology, mesh.scheme); }, [&] { series.smooth(mesh.targets, kM, kPasses); },
         [&] { sweeps(matrix, mesh.targets); }, [&] { const MeshSeries again(mesh.topology, mesh.scheme, by_shape); },
         [&] { cotangent.smooth(mesh.targets, kM, kPasses); }},
        5);
    const std::clock_t start = std::clock();
    for (int i = 0; i < 5; ++i) series.smooth(mesh.targets, kM, kPasses);
    const double processor = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / 5.0;
    const double count = mesh.topology.vertex_count();
    const double bytes = count * kSweepBytes * kPasses * (kM + 1);
    table.add({mesh.name, number(count, 7), number(1e3 * seconds[0]), number(1e3 * seconds[1]), number(1e3 * processor),
               number(1e3 * seconds[3]) + " + " + number(1e3 * seconds[4]), number(1e-9 * bytes / seconds[1]),
               number(1e3 * seconds[2])});
  }
  return "## The mesh series: four passes with m = 2, three columns\n\nSeven applications of A share a pass through "
         "memory. Processor: of all threads together.\n\n" +
         table.text() + "\n";
}

}  // namespace batten::bench
