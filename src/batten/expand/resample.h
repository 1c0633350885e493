/// \file Fits the connectivity of one mesh to the limit surface of another.
#pragma once
#include <memory>

#include "batten/nearest/nearest_point.h"

namespace batten {

/// Control points for the connectivity of `source`, and how far its surface moved.
struct Resampled {
  Values control;             ///< V-by-3: its limit positions lie on the target's limit surface
  double max_distance = 0.0;  ///< from the source's limit positions to their nearest points, in the mesh's unit
  double mean_distance = 0.0;
  Index farthest_vertex = 0;
  Index folded_faces = 0;  ///< faces of the source that turned by more than a right angle
  double max_error = 0.0;  ///< of the interpolation, in the mesh's unit; above 0 only if there is no exact one
};

/// Moves each limit position of the source to the nearest point of the target's limit surface, and finds control points
/// whose surface passes through these points (Interpolator; least squares where that is singular). The surfaces should
/// be close to each other; where they are not, faces fold. Cost: a nearest point for each vertex.
/// Throws what NearestPoints and Interpolator throw, and Error(BadArgument) if a vertex is farther away than `reach`
/// times the diagonal of the target's surface.
Resampled resample(const Topology& source, const Scheme& source_scheme, ConstValuesRef source_control,
                   const Topology& target, const Scheme& target_scheme, ConstValuesRef target_control,
                   double reach = 0.25, const Progress& progress = {});

}  // namespace batten
