#include "cli/film.h"

#include "batten/io/animation.h"

namespace batten::cli {

void write_moving_surface(const std::string& path, const MovingSurface& surface, const WriteOptions& options,
                          const Progress& progress) {
  if (surface.targets.displacements.empty()) {
    write_mesh(path, surface.mesh, options, progress);
  } else {
    write_animation(path, surface.mesh, surface.targets, options, progress);
  }
}

}  // namespace batten::cli
