#include <algorithm>
#include <cmath>
#include <cstdio>

#include "batten/batten.h"

/// One interpolator, many targets: a mesh twists around z, and in every frame its surface passes through its points.
int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const batten::Mesh mesh = batten::read_mesh(argv[1]);
  const batten::Topology topology(mesh);
  const batten::Interpolator interpolator(topology, batten::choose_scheme(mesh));
  batten::Points targets = mesh.points;
  double max_error = 0.0;
  for (int frame = 0; frame < 24; ++frame) {
    for (batten::Index v = 0; v < mesh.vertex_count(); ++v) {
      const double angle = 0.02 * frame * mesh.points(v, 2);
      targets(v, 0) = std::cos(angle) * mesh.points(v, 0) - std::sin(angle) * mesh.points(v, 1);
      targets(v, 1) = std::sin(angle) * mesh.points(v, 0) + std::cos(angle) * mesh.points(v, 1);
    }
    max_error = std::max(max_error, interpolator.solve(targets).report.max_error);
  }
  std::printf("24 frames, max error %.1e\n", max_error);
}
