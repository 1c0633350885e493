#include <cstdio>
#include <cstdlib>

#include "batten/batten.h"

/// Drags one point outwards: in every frame the surface passes through all points, and only what must move moves.
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const batten::Mesh mesh = batten::read_mesh(argv[1]);
  const batten::Interpolator interpolator(batten::Topology(mesh), batten::choose_scheme(mesh));
  batten::InterpolationUpdates surface(interpolator, mesh.points);
  const batten::Index vertex[] = {std::atoi(argv[2])};
  for (int frame = 0; frame < 60; ++frame) {
    const batten::UpdateReport report = surface.update(vertex, 1.01 * surface.targets().row(vertex[0]));
    // surface.moved() are the vertices to draw anew; surface.control() has their points.
    std::printf("%d of %d control points moved, max error %.1e\n", report.moved, mesh.vertex_count(), report.max_error);
  }
}
