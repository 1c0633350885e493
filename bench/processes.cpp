/// Measures whole processes: time, and the peak memory that each reports.
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "batten/io/io.h"
#include "bench/bench.h"

namespace batten::bench {

namespace {

/// The seconds of a child process from start to end.
double run_process(const std::vector<std::string>& command) {
  return seconds_of([&] {
    const pid_t child = fork();
    if (child == 0) {
      std::vector<char*> arguments;
      for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
      arguments.push_back(nullptr);
      execv(arguments[0], arguments.data());
      _exit(127);
    }
    int status = 0;
    waitpid(child, &status, 0);
    if (status != 0) throw std::runtime_error(command[0] + " failed");
  });
}

}  // namespace

int run_large(Index vertices) {
  const Subject large = subject(vertices);
  const Interpolant result = Interpolator(large.topology, large.scheme).solve(large.targets);
  std::fprintf(stderr, "%d vertices, %d iterations, max error %.3g of the diagonal\n", large.topology.vertex_count(),
               result.report.solve.iterations, result.report.max_error / bounding_diagonal(large.targets));
  std::printf("vertices: %d\npeak: %.0f\n", large.topology.vertex_count(),
              1024.0 * number_after("/proc/self/status", "VmHWM:"));
  return result.report.converged() ? 0 : 1;
}

std::string process_section() {
  const std::string folder =
      (std::filesystem::temp_directory_path() / ("batten-bench-" + std::to_string(getpid()))).string();
  std::filesystem::create_directory(folder);
  const std::string input = folder + "/in.ply";
  const std::string report = folder + "/report.json";
  double vertices = 0.0;
  {
    const Subject half = subject(500000);
    vertices = half.topology.vertex_count();
    Mesh mesh = mesh_from_topology(half.topology);
    mesh.points = half.targets;
    write_mesh(input, mesh);
  }
  std::vector<double> seconds;
  for (int i = 0; i < 5; ++i) {
    seconds.push_back(
        run_process({BATTEN_TOOL, "interpolate", input, "-o", folder + "/out.ply", "--report", report, "--quiet"}));
  }
  const double peak = number_after(report, "\"peak_memory_bytes\":");
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  const double large_seconds = run_process({"/bin/sh", "-c", self + " --large 20000000 > " + report});
  const double large_peak = number_after(report, "peak:");
  const double large_vertices = number_after(report, "vertices:");
  std::filesystem::remove_all(folder);
  MarkdownTable table({"", "seconds", "peak memory"});
  table.add({"`batten interpolate` on a binary PLY of " + std::to_string(static_cast<Index>(vertices)) +
                 " vertices, file to file",
             number(median(seconds)), number(peak / vertices) + " bytes a vertex"});
  table.add({std::to_string(static_cast<Index>(large_vertices)) + " vertices refined and interpolated in one process",
             number(large_seconds),
             number(large_peak / (1 << 30)) + " GiB (" + number(large_peak / large_vertices) + " bytes a vertex)"});
  return "## Whole processes\n\n" + table.text() + "\n";
}

}  // namespace batten::bench
