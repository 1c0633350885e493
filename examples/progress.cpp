#include <cstdio>
#include <cstdlib>

#include "batten/batten.h"

/// Shows how far a solve is and cancels it at the given per cent: progress.obj 50
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    const batten::Mesh mesh = batten::read_mesh(argv[1]);
    const batten::Topology topology(mesh);
    const batten::Interpolator interpolator(topology, batten::choose_scheme(mesh));
    const double last = std::atof(argv[2]) / 100.0;
    interpolator.solve(mesh.points, [last](double done) {
      std::printf("%3.0f %%\n", 100.0 * done);
      return done <= last;
    });
    std::puts("solved");
  } catch (const batten::Error& error) {
    if (error.code() == batten::ErrorCode::Cancelled) return std::puts("cancelled"), 0;
    std::fprintf(stderr, "%s\n", error.what());  // names the file and the line, or the element, and says what to do
    return 1;
  }
}
