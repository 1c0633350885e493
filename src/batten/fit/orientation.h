/// \file Local planes of sorted points and the side of each normal.
#pragma once
#include "batten/fit/point_tree.h"
#include "batten/progress.h"

namespace batten {

/// Planes through each point and its nearest ones.
struct LocalPlanes {
  Points normals;     ///< of length 1, on either side
  Scalars roughness;  ///< the least variance over the sum of the three: 0 in a plane, 1/3 for a cloud without one
};

/// Weights fall with the distance. O(N neighbours), threaded.
LocalPlanes local_planes(const Points& points, const NeighbourTable& neighbours);

/// Turns normals to one side: estimate_normals() says how. O(N log N).
void orient_normals(const Points& points, const NeighbourTable& neighbours, Points& normals);

}  // namespace batten
