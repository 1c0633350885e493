/// \file Lengths and areas of a mesh as it is, not of its surface.
#pragma once
#include "batten/mesh/topology.h"

namespace batten {

/// The smallest box along the axes that holds all points.
struct BoundingBox {
  Eigen::RowVector3d low = Eigen::RowVector3d::Zero();
  Eigen::RowVector3d high = Eigen::RowVector3d::Zero();
};

/// Of the points that are finite; zeros where there is none. points: V-by-3. O(V).
BoundingBox bounding_box(const Points& points);

/// The lengths of all edges, in the points' unit; zeros without an edge.
struct EdgeLengths {
  double shortest = 0.0;
  double mean = 0.0;
  double longest = 0.0;
};

/// points: V-by-3. O(E).
EdgeLengths edge_lengths(const Topology& topology, ConstValuesRef points);

/// The area of the faces, each split as triangulate_face does, in squares of the points' unit; not finite where doubles
/// cannot hold it. points: V-by-3. O(H).
double surface_area(const Topology& topology, ConstValuesRef points);

}  // namespace batten
