/// \file A mesh whose vertices stand elsewhere.
#pragma once
#include "batten/mesh/mesh.h"
#include "batten/mesh/topology.h"

namespace batten {

/// The mesh with other points, V-by-3; "normal" attributes, which belonged to the old points, are left out.
/// Throws Error(BadShape).
Mesh with_points(const Mesh& mesh, ConstValuesRef points);

/// The mean length of the edges; 0 for a mesh without edges. points: V-by-3. O(E), threaded.
double mean_edge_length(const Topology& topology, ConstValuesRef points);

}  // namespace batten
