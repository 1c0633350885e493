/// \file The space that points on a surface enclose, as a mask to start from.
#pragma once
#include "batten/volume/volume.h"

namespace batten {

/// What no ball of some radius reaches from outside without a point inside it, on a grid of cubes of its own: the
/// largest piece. The radius is twice the smallest one that encloses half of what the largest does, which is half of
/// the diagonal of the points' box. points: N-by-3, in the world, on the surface, in any order: spread over it, or
/// close together in slices. cells: of the grid along the box's longest side. Throws Error: BadShape, NotFinite,
/// BadArgument (fewer than 6 points, all in a plane, nothing enclosed).
Volume points_mask(const Points& points, Index cells = 40);

}  // namespace batten
