/// \file The volume of closed components, and scaling that preserves it.
#pragma once
#include "batten/expand/mesh_series.h"

namespace batten {

/// The volumes of a mesh's components, positive if faces are counter-clockwise seen from outside.
struct ComponentVolumes {
  Components components;
  std::vector<std::uint8_t> closed;  ///< 1 for a component without a boundary that is not a single vertex
  std::vector<double> volumes;       ///< 0 for open components

  Index closed_count() const;
  double sum() const;
};

/// points: V-by-3. Each face is a fan about its centroid. O(H).
ComponentVolumes component_volumes(const Topology& topology, ConstValuesRef points);

/// The same where the components are known: connected_components(topology).
ComponentVolumes component_volumes(const Topology& topology, ConstValuesRef points, Components components);

/// Scales each closed component about its weighted centroid (MeshSeries::weight) to its former volume. Components with
/// a corner or a kept vertex are not scaled, nor are those that lost more than half of their volume or turned inside
/// out. Returns how many were scaled.
Index restore_volumes(const MeshSeries& series, const ComponentVolumes& before, Points& points);

}  // namespace batten
