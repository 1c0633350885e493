/// \file Boundaries: faces of a contour that no points lie beside are cut away.
#pragma once
#include "batten/fit/cloud_field.h"
#include "batten/mesh/mesh.h"

namespace batten {

/// Cuts away faces that are far from all samples, where such faces together reach farther than half of `bridge` from
/// them; narrower gaps stay closed. What is left is a manifold without faces that hang on by one edge. Returns how
/// many faces were cut away.
Index cut_gaps(Mesh& mesh, const CloudField& field, double face_size, double bridge);

}  // namespace batten
