/// \file Finds where a mesh passes through itself.
#pragma once
#include <array>
#include <vector>

#include "batten/mesh/topology.h"

namespace batten {

/// The intersecting triangles of a mesh.
struct SelfIntersections {
  std::int64_t count = 0;                   ///< of pairs of triangles
  std::vector<std::array<Index, 2>> faces;  ///< of the first pairs, by the lower face
};

/// The pairs of triangles that pass through each other: an edge of one passes through the interior of the other. Faces
/// are split as triangulate_face does. Triangles of the same face, and triangles that share an edge, are not compared
/// (see count_turned_faces), and triangles in a common plane do not count.
/// points: V-by-3, finite. O(n log n) by a tree of boxes for meshes with few intersections; 130 bytes for each
/// triangle. `most_listed` pairs are named. Throws Error(BadShape, NotFinite, Cancelled).
SelfIntersections find_self_intersections(const Topology& topology, ConstValuesRef points,
                                          const Progress& progress = {}, Index most_listed = 10);

/// The number of faces that turned by more than a right angle. After a small deformation these are folded. O(H).
Index count_turned_faces(const Topology& topology, ConstValuesRef before, ConstValuesRef after);

}  // namespace batten
