/// \file What belongs to the elements of a repaired mesh: points, creases, corners, holes, groups, attributes.
#pragma once
#include "batten/mesh/repair_draft.h"

namespace batten {

/// Fills all of result.mesh but its faces, which are there already, with the vertex and face numbers. Where an input
/// edge or vertex became several, each has its tag; where several became one, it has the sharpest. Of welded vertices
/// the lowest one's point and attributes stay, but texture coordinates and normals that differ move to the corners.
void carry_over(const Draft& draft, RepairResult& result, RepairLog& log);

}  // namespace batten
