/// \file Counts of a mesh's elements.
#pragma once
#include <map>
#include <vector>

#include "batten/mesh/topology.h"

namespace batten {

/// A set of faces connected by edges.
struct ComponentSummary {
  Index first_vertex = 0;
  Index vertices = 0;
  Index edges = 0;
  Index faces = 0;
  Index boundary_edges = 0;
  Index boundary_loops = 0;

  bool closed() const { return boundary_loops == 0; }
  Index euler_characteristic() const { return vertices - edges + faces; }
  /// The number of handles: 0 for a sphere or a disk, 1 for a torus.
  Index genus() const { return (2 - boundary_loops - euler_characteristic()) / 2; }
};

/// The components, and counts over the whole mesh.
struct MeshSummary {
  std::vector<ComponentSummary> components;  ///< ordered by lowest vertex
  Index isolated_vertices = 0;
  Index boundary_edges = 0;
  Index boundary_loops = 0;
  std::map<Index, Index> valences;           ///< of interior vertices: number of edges -> number of vertices
  std::map<Index, Index> boundary_valences;  ///< of boundary vertices
  Index sharp_edges = 0;                     ///< interior edges with a tag above 0
  Index semi_sharp_edges = 0;                ///< interior edges with a tag between 0 and kInfiniteSharpness
  float least_sharpness = 0.0F;              ///< of the sharp edges
  float most_sharpness = 0.0F;
  Index darts = 0;  ///< interior vertices where a single sharp edge ends
};

/// O(H).
MeshSummary summarize(const Topology& topology);

/// The same where the components are known: connected_components(topology).
MeshSummary summarize(const Topology& topology, const Components& components);

}  // namespace batten
