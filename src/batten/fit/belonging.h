/// \file How surely points belong to a surface on the way to them.
#pragma once
#include <cstdint>

#include "batten/buffer.h"
#include "batten/fit/point_tree.h"
#include "batten/types.h"

namespace batten {

/// What is known of a cloud before its surface: N points.
struct CloudOdds {
  const Points& points;
  const NeighbourTable& neighbours;
  const Buffer<std::uint8_t>&
      far;         ///< one flag a point, 1 for outliers that are sure; these do not count as neighbours
  double spacing;  ///< the usual distance of points that are neighbours
};

/// For each point the probability that it belongs to the surface and is no outlier, 0 for those that are far. offsets:
/// N-by-3, from the nearest place of the surface. A point that belongs differs little from the median of its
/// neighbours' offsets, whatever these are, since a part that the surface has not reached is missed as a whole: how
/// little is what its neighbours differ by in the median. Outliers lie anywhere in the box, as densely as the far ones
/// do: without these every point belongs. O(N neighbours), threaded.
Scalars belonging(const CloudOdds& cloud, const Points& offsets);

}  // namespace batten
