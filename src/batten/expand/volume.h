/// \file The volume inside of closed components, and scaling that keeps it.
#pragma once
#include "batten/expand/mesh_series.h"

namespace batten {

/// The volumes of a mesh's components; positive where faces are counter-clockwise seen from outside.
struct ComponentVolumes {
  Components components;
  std::vector<std::uint8_t> closed;  ///< a component without a boundary, and not a lone vertex
  std::vector<double> volumes;       ///< 0 for the others

  Index closed_count() const;
  double sum() const;
};

/// points: V-by-3. Faces are taken as fans about their centroids. O(H).
ComponentVolumes component_volumes(const Topology& topology, ConstValuesRef points);

/// Scales each closed component about its weighted centroid (MeshSeries::weight) to the volume that it had; not those
/// that have a corner or a kept vertex, and none that lost more than half of its volume to start with or turned inside
/// out. Returns how many were scaled.
Index restore_volumes(const MeshSeries& series, const ComponentVolumes& before, Points& points);

}  // namespace batten
