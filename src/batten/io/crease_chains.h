/// \file Creases joined into polylines.
#pragma once
#include <vector>

#include "batten/mesh/mesh.h"

namespace batten::io {

/// Consecutive edges of the same sharpness. A closed chain repeats its first vertex at the end.
struct CreaseChain {
  std::vector<Index> vertices;
  double sharpness;
};

/// The chains contain every edge with a sharpness above 0 once, with its last tag and at most kInfiniteSharpness. A
/// chain ends where the number of edges of its sharpness is not two. O(n log n).
std::vector<CreaseChain> crease_chains(const std::vector<Crease>& creases);

}  // namespace batten::io
