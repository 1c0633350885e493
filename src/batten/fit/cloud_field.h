/// \file The surface of a cloud as the contour of a field.
#pragma once
#include "batten/fit/cloud_samples.h"
#include "batten/fit/value_grid.h"

namespace batten {

/// A cloud with what is asked of it over and over.
struct CloudField {
  /// The grid is as fine as the samples, at most fine enough for so many vertices and for 200 cells.
  CloudField(CloudSamples prepared, Index vertices, const Progress& progress = {});

  CloudSamples samples;
  PointTree tree;    ///< of the samples
  ValueGrid grid;    ///< winding numbers less those on the surface: positive inside
  double level = 0;  ///< the winding number on the surface

  /// The place near `place` that the samples give: in the plane through their mean where there are samples nearer than
  /// `reach`, otherwise on the contour of the grid. Samples with normals against `normal` do not count.
  Eigen::RowVector3d nearest_place(const Eigen::RowVector3d& place, const Eigen::RowVector3d& normal) const;
};

}  // namespace batten
