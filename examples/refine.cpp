#include <cstdio>

#include "batten/batten.h"

/// Refines a control mesh twice, moves its vertices to the limit surface and writes them with the surface's normals.
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const batten::Mesh control = batten::read_mesh(argv[1]);
  const batten::Scheme scheme = batten::choose_scheme(control);
  const batten::Topology topology(control);
  const batten::RefinedSurface fine = batten::refine(topology, scheme, control.points, 2);
  batten::Mesh surface = batten::mesh_from_topology(fine.topology);
  surface.points = batten::LimitMatrix(fine.topology, scheme).apply(fine.values);
  surface.attributes.push_back({"normal", batten::limit_normals(fine.topology, scheme, fine.values).vertices, {}});
  batten::write_mesh(argv[2], surface);
  std::printf("%d faces became %d\n", control.face_count(), surface.face_count());
}
