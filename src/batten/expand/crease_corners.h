/// \file The places of vertices where found creases meet, which no smoothing along a curve reaches.
#pragma once
#include <vector>

#include "batten/mesh/topology.h"

namespace batten {

/// The vertices at which three or more sharp edges or boundaries meet in `creased`, but not in `given`, the same mesh
/// before sharp edges were found. O(H).
std::vector<Index> found_corners(const Topology& given, const Topology& creased);

/// For each of the vertices the point that lies nearest to the planes of the faces one ring further out, and where
/// these leave it free, to its row of `held`: so a corner is where the sides around it meet. A vertex that would move
/// farther than `most` from its noisy position stays there: its sides are not as plain as that. smoothed: V-by-3, the
/// other vertices' places. One row a vertex. O(ring).
Points corner_places(const Topology& topology, const std::vector<Index>& vertices, ConstValuesRef smoothed,
                     ConstValuesRef noisy, ConstValuesRef held, double most);

}  // namespace batten
