/// \file How many sharp edges a control mesh has, and where they meet and end.
#pragma once
#include "batten/mesh/topology.h"

namespace batten {

/// The creases of a control mesh; boundaries are none.
struct CreaseCounts {
  Index edges = 0;    ///< inner edges with any sharpness
  Index corners = 0;  ///< vertices where three or more creases meet, and those tagged as corners
  Index darts = 0;    ///< inner vertices where one ends
};

/// O(E).
CreaseCounts count_creases(const Topology& topology);

}  // namespace batten
