/// \file A cloud of points on a surface, and the normals of one.
#pragma once
#include "batten/progress.h"
#include "batten/types.h"

namespace batten {

/// Points on or near a surface, in any order.
struct PointCloud {
  Points points = Points(0, 3);   ///< N-by-3
  Points normals = Points(0, 3);  ///< N-by-3 of length 1, outwards; or without rows where they are not known
};

/// Options of estimate_normals().
struct NormalEstimate {
  Index neighbours = 12;  ///< how many points a local plane is laid through, besides its own: 3 to 100
};

/// Normals of length 1 by planes through the nearest points, all on the same side of the surface: outwards where it is
/// closed. Hoppe and others 1992 (key HDDMS92): the choice of side is handed on along a spanning tree of the
/// neighbours, from the outermost point of each connected part on. Unlike there, two neighbours agree when each normal
/// is the other's mirror image in the plane halfway between the points, as on a circle (Koenig and Gumhold 2009, key
/// KG09), which is right at sharp edges and across thin plates too. Points at the same place get the same normal; those
/// without a plane (all neighbours on a line) get any at right angles. A point's normal does not depend on the order of
/// points. O(N log N). Throws Error: BadShape, NotFinite, BadArgument, Cancelled.
Points estimate_normals(ConstValuesRef points, const NormalEstimate& options = {}, const Progress& progress = {});

}  // namespace batten
