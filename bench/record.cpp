/// The bench of record: runs everything and writes a page.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

#include "batten/mesh/primitives.h"
#include "batten/parallel/parallel.h"
#include "bench/bench.h"

namespace batten::bench {

namespace {

std::string topology_section() {
  const Mesh mesh = torus(1000, 1000);
  const double seconds = in_turn({[&] { const Topology topology(mesh); }}, 5)[0];
  return "## Topology\n\n1 M quads from index lists to half-edge tables: " + number(1e3 * seconds) + " ms.\n\n";
}

}  // namespace
}  // namespace batten::bench

int main(int argc, char** argv) {
  using namespace batten::bench;
  if (argc == 3 && std::string(argv[1]) == "--large") return run_large(std::stoi(argv[2]));
  if (argc == 2 && std::string(argv[1]) == "--dynamics") {
    std::printf("%s", dynamics_section().c_str());
    return 0;
  }
  if (argc != 2) {
    std::fprintf(stderr, "usage: batten_bench PAGE.md, or --dynamics for that part alone\n");
    return 2;
  }
  std::string page = "Threads: " + std::to_string(batten::thread_count()) + ". " + machine() + "\n";
  for (const auto& section : {topology_section, interpolation_section, update_section, growth_section, file_section,
                              picture_section, nearest_section, series_section, dynamics_section, process_section}) {
    page += section();
    std::fprintf(stderr, "%s", page.substr(page.rfind("\n## ")).c_str());
  }
  write_part(argv[1], "", page);
  return 0;
}
