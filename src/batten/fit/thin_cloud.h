/// \file Fewer points of a large cloud, spread as evenly.
#pragma once
#include "batten/buffer.h"
#include "batten/types.h"

namespace batten {

/// The rows of some `most` points, or all where there are no more: one a box of a grid, the one nearest to the middle
/// of the box. Which points are chosen does not depend on their order, but for points at the same place. Ascending.
/// points: N-by-3, finite. O(N log N).
Buffer<Index> thinned_rows(const Points& points, Index most);

}  // namespace batten
