/// \file The space that points on a surface enclose, as a mask to start from.
#pragma once
#include <vector>

#include "batten/volume/volume.h"

namespace batten {

/// What no ball of some radius reaches from outside without a point inside it, on a grid of cubes of its own: the
/// largest piece. The radius is twice the smallest one that encloses half of what the largest does, which is half of
/// the diagonal of the points' box. points: N-by-3, in the world, on the surface, in any order: spread over it, or
/// close together in slices. cells: of the grid along the box's longest side. Throws Error: BadShape, NotFinite,
/// BadArgument (fewer than 6 points, all in a plane, nothing enclosed).
Volume points_mask(const Points& points, Index cells = 40);

/// The rows of points but for those deep in gaps that are too narrow for the others: a ball of one and a half times the
/// median distance between neighbours, which rolls around the points, stays away from them by more than a third of that
/// distance. So few points say where a gap is, but not how it goes on, and a surface drawn to them is dented. Of
/// thousands of points all are kept. points: N-by-3. Throws Error(NotFinite).
std::vector<Eigen::Index> points_outside_gaps(const Points& points);

}  // namespace batten
