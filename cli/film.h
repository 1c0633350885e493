/// \file A surface that moves, as a GLB.
#pragma once
#include <string>

#include "batten/io/io.h"
#include "batten/tessellate/moving_surface.h"

namespace batten::cli {

/// Writes an animation, or where there is but one shape a mesh.
void write_moving_surface(const std::string& path, const MovingSurface& surface, const WriteOptions& options,
                          const Progress& progress);

}  // namespace batten::cli
