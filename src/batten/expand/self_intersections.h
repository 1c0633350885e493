/// \file Where a mesh passes through itself.
#pragma once
#include <array>
#include <vector>

#include "batten/mesh/topology.h"

namespace batten {

/// What was found.
struct SelfIntersections {
  std::int64_t count = 0;                   ///< pairs of triangles
  std::vector<std::array<Index, 2>> faces;  ///< of the first ten pairs, by the lower face
};

/// The pairs of triangles that pass through each other: an edge of the one runs through the inside of the other. Faces
/// are split as triangulate_face does. Triangles of one face, and those that share an edge, are not compared (see
/// count_turned_faces), and triangles that lie in one plane do not count.
/// points: V-by-3, finite. O(n log n) by a tree of boxes for meshes with few intersections; 100 bytes a triangle.
/// Throws Error(BadShape, NotFinite, Cancelled).
SelfIntersections find_self_intersections(const Topology& topology, ConstValuesRef points,
                                          const Progress& progress = {});

/// How many faces have turned by more than a right angle: folded over, where a mesh was deformed a little. O(H).
Index count_turned_faces(const Topology& topology, ConstValuesRef before, ConstValuesRef after);

}  // namespace batten
