#include <cstdio>

#include "batten/batten.h"

/// A surface through the points of a mesh that also has the normals estimated there, and what that costs in bending.
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const batten::Mesh mesh = batten::read_mesh(argv[1]);
  const batten::Values wanted = batten::estimated_wanted_normals(batten::Topology(mesh), mesh.points);
  batten::InterpolatedMesh surface = batten::interpolate(mesh);
  const batten::TurnReport report = batten::turn_normals(surface, wanted);
  std::printf("turned %d, off by at most %.2g degrees, bending %.3f instead of %.3f\n", report.counts.turned,
              57.3 * report.after_angle.max, report.energy.relaxed, report.energy.before);
  batten::write_mesh(argv[2], surface.mesh);
}
