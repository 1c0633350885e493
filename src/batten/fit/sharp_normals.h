/// \file Normals of samples that do not mix the sides of sharp edges.
#pragma once
#include "batten/fit/point_tree.h"

namespace batten {

/// Local planes at a sharp edge are laid through points of both sides. Where a point's normal disagrees with those
/// around it much more than a neighbour's does, and the point lies in the neighbour's plane, it takes that normal
/// (after Kuwahara's filter for images: of several windows the most even one). Rounds of this clear the points beside
/// the edge. Where neighbours still disagree, each point then takes the mean normal of those on the side in whose
/// planes it lies best. Where the surface is smooth all disagree as much, and normals stay. points, normals: N-by-3, of
/// length 1, on one side. O(N neighbours), threaded.
Points sharp_normals(const Points& points, Points normals, const NeighbourTable& neighbours);

}  // namespace batten
