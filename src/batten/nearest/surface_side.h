/// \file On which side of a surface a point lies.
#pragma once
#include "batten/nearest/nearest_point.h"

namespace batten {

/// Which side of a surface a point lies on.
enum class SurfaceSide { Outside, Inside };

/// By the normal at the nearest point, which faces turned counter-clockwise have on the outside. On a crease or a
/// corner it is the normal of the adjacent face that the query sees best, which is right wherever two faces meet, and
/// where more do unless they alternate like the pleats of a fan. A point of the surface is outside. O(valence).
SurfaceSide side_of(const LimitSurface& surface, const Eigen::Vector3d& query, const NearestPoint& nearest);

/// True where every edge has two faces, none of them a hole: then outside and inside are parts of space.
bool encloses_space(const Topology& topology);

}  // namespace batten
