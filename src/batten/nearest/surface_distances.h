/// \file How far points lie from a limit surface, and on which side.
#pragma once
#include <vector>

#include "batten/nearest/nearest_point.h"

namespace batten {

/// Row i belongs to point i.
struct SurfaceDistances {
  std::vector<NearestPoint> nearest;
  Scalars distances;       ///< in the points' unit; negative inside a closed surface
  bool closed = false;     ///< encloses_space(): whether there is an inside
  double diagonal = 0.0;   ///< of the surface's box
  double tolerance = 0.0;  ///< of each distance, as NearestPoints::tolerance()
};

/// control: V-by-3; points: N-by-3. A point within the tolerance counts as outside. Threaded; costs as NearestPoints.
/// Throws Error(NotFinite) where squares of lengths are not finite, and what NearestPoints throws.
SurfaceDistances measure_distances(const Topology& topology, const Scheme& scheme, ConstValuesRef control,
                                   ConstValuesRef points, const Progress& progress = {});

}  // namespace batten
