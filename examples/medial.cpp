#include <cstdio>

#include "batten/batten.h"

/// The surface through the spoke ends of a medial model, and how well it fits the atoms.
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const batten::MedialSurface made = batten::medial_surface(batten::read_medial(argv[1]));
  const batten::MedialErrors& errors = made.errors;
  std::printf(
      "off the spoke ends by %.2g of the radius, off the spokes' directions by %.3g rad, atoms shifted by %.3g\n",
      errors.distance_share.max, errors.angle.max, errors.shift.max);
  batten::write_mesh(argv[2], made.surface.mesh);
}
