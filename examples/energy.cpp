#include <cstdio>

#include "batten/batten.h"

/// Says how much more a surface bends that passes through its control points.
int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const batten::Mesh control = batten::read_mesh(argv[1]);
  const batten::Topology topology(control);
  const batten::Scheme scheme = batten::choose_scheme(control);
  const batten::SurfaceEnergy energy(topology, scheme);
  const batten::Interpolant through = batten::Interpolator(topology, scheme).solve(control.points);
  std::printf("bending energy: plain %.4g, through the points %.4g\n",
              energy.energy(batten::EnergyKind::ThinPlate, control.points),
              energy.energy(batten::EnergyKind::ThinPlate, through.control));
}
