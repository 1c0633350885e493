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

FoundContour find_contour(const CloudField& field, const FirstMeshOptions& options);

}  // namespace batten
