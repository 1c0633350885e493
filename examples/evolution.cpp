#include <cstdio>

#include "batten/batten.h"

/// Springs draw a sphere to the points of a mesh; an animation shows how.
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  batten::SurfaceFilm film;
  batten::FitOptions options;
  options.method = batten::FitMethod::Dynamic;
  options.start = batten::FitStart::Sphere;
  options.watch = [&](const batten::SurfaceFrame& frame) { film.add(frame); };
  batten::fit_surface({batten::read_mesh(argv[1]).points, batten::Points(0, 3)}, options);
  const batten::MovingSurface surface = film.moving(12.0, 2);
  batten::write_animation(argv[2], surface.mesh, surface.targets);
  std::printf("%d frames\n", film.size());
}
