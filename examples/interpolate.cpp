#include <cstdio>

#include "batten/batten.h"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  batten::Mesh mesh = batten::read_mesh(argv[1]);
  const batten::Topology topology(mesh);
  const batten::Interpolator interpolator(topology, batten::choose_scheme(mesh));
  const batten::Interpolant result = interpolator.solve(mesh.points);
  std::printf("max error %g at vertex %d\n", result.max_error, result.worst.front().row);
  mesh.points = result.control;
  batten::write_mesh(argv[2], mesh);
}
