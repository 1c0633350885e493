/// \file Where a surface changes when control vertices move.
#pragma once
#include <span>
#include <vector>

#include "batten/patch/surface_patches.h"

namespace batten {

/// The base faces in which some place depends on the control vertices given: those that lie in two rings of control
/// faces around them. The bicubic and the box spline of a vertex end there; irregular vertices, boundaries and creases
/// make nothing reach farther. Not for the Butterflies. Ascending, each once. O(n log n) of the corners in the rings.
std::vector<Index> reached_faces(const SurfacePatches& patches, std::span<const Index> vertices);

}  // namespace batten
