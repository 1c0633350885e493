/// \file The volumes that the components of a mesh enclose.
#pragma once
#include <cstdint>
#include <vector>

#include "batten/mesh/topology.h"

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

}  // namespace batten
