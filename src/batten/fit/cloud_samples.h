/// \file What a first mesh is made from: a cloud without repeated points and outliers, in a unit of its own.
#pragma once
#include "batten/fit/point_cloud.h"
#include "batten/fit/point_tree.h"

namespace batten {

/// The rows of points in the order of x, then y, then z, then of `then` (without rows: no more). What is made from
/// sorted points does not depend on their order. O(N log N).
Buffer<Index> sorted_rows(const Points& points, const Points& then = Points(0, 3));

/// Points in a unit in which the box around them has a longest side of 1, sorted.
struct CloudSamples {
  Points points;
  Points normals;   ///< of length 1, outwards
  Scalars areas;    ///< the part of the surface that each point stands for
  Scalars spacing;  ///< the usual distance of points that are neighbours there
  Eigen::RowVector3d centre;
  double size = 1.0;     ///< a place in the cloud's unit is centre + size * place
  Index given = 0;       ///< points of the cloud
  Index repeated = 0;    ///< points at the place of another
  Index outliers = 0;    ///< points left out
  double typical = 0.0;  ///< the median spacing
};

/// Throws Error: BadShape, NotFinite where a cloud is not one.
void require_cloud(const PointCloud& cloud);

/// Sorts, thins clouds of more points than a mesh of so many vertices needs to the means of small boxes, leaves out
/// outliers, finds normals where there are none. Throws Error: BadArgument (fewer than 20 places, all on one line),
/// Cancelled. O(N log N).
CloudSamples prepare_cloud(const PointCloud& cloud, Index vertices, const Progress& progress = {});

}  // namespace batten
