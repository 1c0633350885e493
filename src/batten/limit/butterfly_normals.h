/// \file Limit normals of the Butterflies at the vertices of a mesh of any level.
#pragma once
#include "batten/limit/limit_matrix.h"

namespace batten {

/// Exact at every vertex where the scheme has a tangent plane, whatever its neighbours: the masks act on the two rings
/// after one more step, made for each vertex alone. Where there is none: at corners the average of the cone that their
/// edges' tangents make, and so where Butterfly is not smooth; in a single triangle that a curve passes by, the plane
/// of the curve and the next point at this level. As limit_normals, which calls this.
LimitNormals butterfly_normals(const Topology& topology, const Scheme& scheme, ConstValuesRef points,
                               const Progress& progress = {});

}  // namespace batten
