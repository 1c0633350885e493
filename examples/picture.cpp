#include "batten/batten.h"
#include "batten/render/render.h"

/// A picture of the surface of a control mesh, with the control mesh as lines.
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const batten::Mesh control = batten::read_mesh(argv[1]);
  const batten::Scheme scheme = batten::choose_scheme(control);
  const batten::Topology topology(control);
  const batten::RefinedSurface fine = batten::refine(topology, scheme, control.points, 3);
  batten::Scene scene;
  scene.surface = batten::mesh_from_topology(fine.topology);
  scene.surface.points = batten::LimitMatrix(fine.topology, scheme).apply(fine.values);
  scene.lines = control;
  batten::RenderOptions options;
  options.width = 640;
  options.height = 480;
  batten::write_png(argv[2], batten::render(scene, options));
}
