/// \file On which side of a surface a point lies.
#pragma once
#include "batten/nearest/nearest_point.h"

namespace batten {

/// Which side of a surface a point lies on.
enum class SurfaceSide { Outside, Inside };

/// Decides by the normal at the nearest point, which points outwards where faces run counter-clockwise. On a crease or
/// a corner it takes the normal of the adjacent face that is turned most towards or away from the query. That is right
/// wherever two faces meet, and where more meet unless they alternate like the pleats of a fan. A point of the surface
/// is outside. O(valence).
SurfaceSide side_of(const LimitSurface& surface, const Eigen::Vector3d& query, const NearestPoint& nearest);

/// True where every edge has two faces, none of them a hole, so that the surface divides space into an outside and an
/// inside.
bool encloses_space(const Topology& topology);

}  // namespace batten
