/// \file A grid whose contour has the topology of the surface, made coarser.
#pragma once
#include "batten/fit/cloud_field.h"
#include "batten/fit/first_mesh.h"

namespace batten {

/// A contour in the unit of the samples.
struct FoundContour {
  Mesh mesh;
  double spacing = 0.0;
  Index dropped = 0;
};

/// The contour of the shape that most grids give, made coarser to about the vertices asked for. Throws
/// Error: NotConverged, Cancelled.
FoundContour find_contour(const CloudField& field, const FirstMeshOptions& options, const Progress& progress = {});

}  // namespace batten
