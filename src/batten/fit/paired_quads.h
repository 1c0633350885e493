/// \file Triangles joined in pairs.
#pragma once
#include "batten/mesh/mesh.h"

namespace batten {

/// Joins triangles in pairs to quads, the squarest first, then by a matching of as many as possible (Edmonds 1965, key
/// E65): on a closed surface all find a partner (Petersen 1891), on one with boundaries a few triangles may stay.
/// Inner vertices that would have two edges are taken out. `mesh`: triangles that Topology accepts. O(F^2) at worst,
/// O(F log F) as a rule.
Mesh paired_quads(const Mesh& mesh);

}  // namespace batten
