/// \file The grid whose contour has about so many vertices and the topology of the surface.
#pragma once
#include "batten/fit/cloud_field.h"
#include "batten/fit/first_mesh.h"

namespace batten {

/// A contour in the unit of the samples.
struct FoundContour {
  Mesh mesh;
  double spacing = 0.0;
  Index dropped = 0;
  bool simplified = false;  ///< a finer contour was made coarser
};

/// The contour with the shape that most grids give, with a vertex near each place that is said to have one. Throws
/// Error: NotConverged, Cancelled.
FoundContour find_contour(const CloudField& field, const FirstMeshOptions& options, const Progress& progress = {});

}  // namespace batten
