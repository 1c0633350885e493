/// \file Scaling that gives closed components their volume back.
#pragma once
#include "batten/expand/mesh_series.h"
#include "batten/mesh/component_volumes.h"

namespace batten {

/// Scales each closed component about its weighted centroid (MeshSeries::weight) to its former volume. Components with
/// a corner or a kept vertex are not scaled, nor are those that lost more than half of their volume or turned inside
/// out. Returns how many were scaled.
Index restore_volumes(const MeshSeries& series, const ComponentVolumes& before, Points& points);

}  // namespace batten
