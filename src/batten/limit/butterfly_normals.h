/// \file Limit normals of the Butterflies at the vertices of a mesh of any level.
#pragma once
#include "batten/limit/limit_matrix.h"

namespace batten {

/// Limit normals, as limit_normals returns them; it calls this function. They are exact at every vertex with a tangent
/// plane, whatever its neighbours are: the masks act on the two rings after one more step, which is made for each
/// vertex alone. Where there is no tangent plane (at corners, and where Butterfly is not smooth), the normal is the
/// average over the cone of the edges' tangents. In a single triangle beside a curve it is the normal of the plane
/// through the curve and the next point at this level.
LimitNormals butterfly_normals(const Topology& topology, const Scheme& scheme, ConstValuesRef points,
                               const Progress& progress = {});

}  // namespace batten
