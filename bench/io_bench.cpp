/// \file Reads and writes files of about 100 MB in the page cache.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "batten/io/io.h"

namespace {

using batten::Index;
using batten::Mesh;

/// A wavy grid of quads with side * side vertices, whose doubles have all their digits, as in computed meshes.
Mesh make_grid(Index side) {
  Mesh mesh;
  mesh.points.resize(Eigen::Index{side} * side, 3);
  for (Index i = 0; i < side; ++i) {
    for (Index j = 0; j < side; ++j) {
      const double x = i / 1000.0;
      const double y = j / 1000.0;
      mesh.points.row(Eigen::Index{side} * i + j) << std::cos(x) * 3.0, std::sin(y) * 2.0, std::sin(x * y);
    }
  }
  for (Index i = 0; i + 1 < side; ++i) {
    for (Index j = 0; j + 1 < side; ++j) {
      const Index a = i * side + j;
      mesh.add_face({a, a + side, a + side + 1, a + 1});
    }
  }
  return mesh;
}

struct Subject {
  const char* format;
  bool binary;
  Index side;  ///< so that the file has about 100 MB
};

constexpr Subject kSubjects[] = {{"obj", true, 1130}, {"ply", true, 1570}, {"ply", false, 1130},
                                 {"off", true, 1130}, {"xyz", true, 1400}, {"stl", true, 1000}};

std::string path_of(const Subject& subject) {
  const std::string name = "batten-io-bench-" + std::to_string(::getpid()) + "." + subject.format;
  return (std::filesystem::temp_directory_path() / name).string();
}

void read(benchmark::State& state, const Subject& subject) {
  const std::string path = path_of(subject);
  batten::write_mesh(path, make_grid(subject.side), {"", subject.binary});
  for (auto _ : state) benchmark::DoNotOptimize(batten::read_mesh(path).vertex_count());
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(std::filesystem::file_size(path)));
  std::filesystem::remove(path);
}

void write(benchmark::State& state, const Subject& subject) {
  const std::string path = path_of(subject);
  const Mesh mesh = make_grid(subject.side);
  for (auto _ : state) batten::write_mesh(path, mesh, {"", subject.binary});
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(std::filesystem::file_size(path)));
  std::filesystem::remove(path);
}

}  // namespace

int main(int argc, char** argv) {
  for (const Subject& subject : kSubjects) {
    const std::string name = std::string(subject.format) + (subject.binary ? "" : "_text");
    const auto add = [&](const std::string& verb, void (*body)(benchmark::State&, const Subject&)) {
      benchmark::RegisterBenchmark((verb + name).c_str(),
                                   [body, subject](benchmark::State& state) { body(state, subject); })
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime();
    };
    add("read_", read);
    add("write_", write);
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
