#include <cstdio>

#include "batten/batten.h"

/// Finds the fairest surface through a mesh's points and says what it has gained.
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  batten::Mesh mesh = batten::read_mesh(argv[1]);
  const batten::Topology topology(mesh);
  const batten::Scheme scheme = batten::choose_scheme(mesh);
  const batten::FairMesh fair = batten::interpolate_fairly(topology, scheme, mesh, batten::AttributeRule::Interpolated);
  std::printf("variation of curvature: plain %.4g, fair %.4g\n", fair.report.plain_energy, fair.report.energy);
  batten::write_mesh(argv[2], fair.mesh);
}
