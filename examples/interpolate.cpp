#include <cstdio>

#include "batten/batten.h"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const batten::InterpolatedMesh result = batten::interpolate(batten::read_mesh(argv[1]));
  const batten::InterpolationReport& points = result.reports.front();
  std::printf("max error %g at vertex %d\n", points.max_error, points.worst.front().row);
  batten::write_mesh(argv[2], result.mesh);
}
