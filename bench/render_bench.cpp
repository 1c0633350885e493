/// Draws 1600x1200 pictures with 2x2 samples per pixel: a torus of a million triangles, smooth and bumpy.
#include <benchmark/benchmark.h>

#include <cmath>

#include "batten/mesh/primitives.h"
#include "batten/render/render.h"

namespace {

using namespace batten;

Scene million_triangles(double bumps) {
  Scene scene;
  scene.surface = torus(1000, 500, 1.0, 0.45);
  for (Index v = 0; v < scene.surface.vertex_count(); ++v) {
    const double x = scene.surface.points(v, 0);
    const double y = scene.surface.points(v, 1);
    scene.surface.points(v, 2) *= 1.0 + bumps * std::sin(40.0 * x) * std::sin(40.0 * y);
  }
  return scene;
}

void picture_of_a_million_triangles(benchmark::State& state, double bumps) {
  const Scene scene = million_triangles(bumps);
  for (auto _ : state) {
    const Picture picture = render(scene);
    benchmark::DoNotOptimize(picture.pixels.data());
  }
  state.counters["triangles/s"] = benchmark::Counter(1e6, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK_CAPTURE(picture_of_a_million_triangles, smooth, 0.0)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(picture_of_a_million_triangles, bumpy, 0.15)->Unit(benchmark::kMillisecond)->UseRealTime();

void png_of_a_picture(benchmark::State& state) {
  const Picture picture = render(million_triangles(0.15));
  std::size_t bytes = 0;
  for (auto _ : state) bytes = encode_png(picture).size();
  state.counters["bytes"] = static_cast<double>(bytes);
}
BENCHMARK(png_of_a_picture)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
