/// \file The data of a repaired mesh's elements: points, creases, corners, holes, groups, attributes.
#pragma once
#include "batten/mesh/repair_draft.h"

namespace batten {

/// Fills all of result.mesh except its faces and the vertex and face numbers, which the caller has set. Where an input
/// edge or vertex became several, each gets its tag; where several became one, it gets the sharpest. Of welded
/// vertices, the point and attributes of the lowest are kept, but texture coordinates and normals that differ are moved
/// to the corners.
void carry_over(const Draft& draft, RepairResult& result, RepairLog& log);

}  // namespace batten
