/// \file Parts of a cloud that are far apart for their size.
#pragma once
#include <vector>

#include "batten/buffer.h"
#include "batten/types.h"

namespace batten {

/// The rows of each group of points. A cloud is taken apart where its points lie in a few places of a box that is much
/// larger than each: one grid would be too coarse for them. Groups of fewer points than `fewest` are left out, unless
/// all are. Ordered by their outermost points. O(N) a group within a group.
std::vector<Buffer<Index>> far_groups(const Points& points, Index fewest);

}  // namespace batten
