/// \file Vertices of a contour spread evenly and moved to the points.
#pragma once
#include "batten/fit/cloud_field.h"
#include "batten/mesh/mesh.h"

namespace batten {

/// In each round every vertex moves along the surface towards the mean of its neighbours and then to the place that the
/// samples near it give.
void relax_contour(Mesh& mesh, const CloudField& field, int rounds);

}  // namespace batten
