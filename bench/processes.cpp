/// Whole processes: time and peak memory as the operating system counts them.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "batten/io/io.h"
#include "bench/bench.h"

namespace batten::bench {

namespace {

struct ProcessCost {
  double seconds = 0.0;
  double peak_bytes = 0.0;
};

ProcessCost run_process(const std::vector<std::string>& command) {
  ProcessCost cost;
  cost.seconds = seconds_of([&] {
    const pid_t child = fork();
    if (child == 0) {
      std::vector<char*> arguments;
      for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
      arguments.push_back(nullptr);
      execv(arguments[0], arguments.data());
      _exit(127);
    }
    int status = 0;
    rusage usage{};
    wait4(child, &status, 0, &usage);
    if (status != 0) throw std::runtime_error(command[0] + " failed");
    cost.peak_bytes = 1024.0 * static_cast<double>(usage.ru_maxrss);
  });
  return cost;
}

ProcessCost median_process(const std::vector<std::string>& command, int rounds) {
  std::vector<double> seconds;
  std::vector<double> bytes;
  for (int i = 0; i < rounds; ++i) {
    const ProcessCost cost = run_process(command);
    seconds.push_back(cost.seconds);
    bytes.push_back(cost.peak_bytes);
  }
  return {median(seconds), median(bytes)};
}

}  // namespace

int run_large(Index vertices) {
  Subject large = subject(vertices);
  const Interpolant result = Interpolator(large.topology, large.scheme).solve(large.targets);
  std::printf("%d vertices, %d iterations, max error %.3g of the diagonal\n", large.topology.vertex_count(),
              result.report.iterations, result.max_error / bounding_diagonal(large.targets));
  return result.report.converged ? 0 : 1;
}

std::string process_section() {
  const std::string folder = (std::filesystem::temp_directory_path() / ("batten-bench-" + std::to_string(getpid()))).string();
  std::filesystem::create_directory(folder);
  const Subject subject_half = subject(500000);
  Mesh mesh = mesh_from_topology(subject_half.topology);
  mesh.points = subject_half.targets;
  const std::string input = folder + "/in.ply";
  write_mesh(input, mesh);
  mesh = Mesh();
  const double vertices = subject_half.topology.vertex_count();
  const ProcessCost file =
      median_process({BATTEN_TOOL, "interpolate", input, "-o", folder + "/out.ply", "--quiet"}, 5);
  std::filesystem::remove_all(folder);
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  const ProcessCost large = run_process({self, "--large", "20000000"});
  MarkdownTable table({"", "seconds", "peak memory", "asked"});
  table.add({"`batten interpolate` on a binary PLY of " + std::to_string(subject_half.topology.vertex_count()) +
                 " vertices, file to file",
             number(file.seconds), number(file.peak_bytes / vertices) + " bytes a vertex", "0.8 s, 500 bytes a vertex"});
  table.add({"a mesh refined to over 20 M vertices, interpolated in one process", number(large.seconds),
             number(large.peak_bytes / (1 << 30)) + " GiB", "12 GiB"});
  return "## Whole processes\n\n" + table.text() + "\n";
}

}  // namespace batten::bench
