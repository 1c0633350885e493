/// \file Creases joined into polylines.
#pragma once
#include <vector>

#include "batten/mesh/mesh.h"

namespace batten::io {

/// Consecutive edges of one sharpness; a closed one ends with its first vertex.
struct CreaseChain {
  std::vector<Index> vertices;
  double sharpness;
};

/// Every edge that is tagged with a sharpness above 0 once, with its last tag; sharpness at most kInfiniteSharpness.
/// Chains end where the number of edges of their sharpness is not two. O(n log n).
std::vector<CreaseChain> crease_chains(const std::vector<Crease>& creases);

}  // namespace batten::io
