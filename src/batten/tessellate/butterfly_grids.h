/// \file The refined points of Butterfly and Modified Butterfly, face by face of the base, without refined
/// connectivity.
#pragma once
#include "batten/limit/limit_matrix.h"
#include "batten/mesh/topology.h"
#include "batten/progress.h"
#include "batten/scheme/scheme.h"

namespace batten {

/// `levels` steps, 1 or more, of a base of triangles. control: V-by-k; out: room for the vertices of
/// TessellationLayout(base, false, levels), k numbers each. Each level is filled from the one before it, kept in
/// doubles: within a face and across its sides the stencil slides over rows of the lattice; around the base's vertices
/// and beside sharp edges the rules walk (tessellate/lattice_walk.h). The same points as refine()'s, to rounding.
/// O(output), threaded. Throws Error(Cancelled).
template <typename Scalar>
void fill_butterfly_grids(const Topology& base, const Scheme& scheme, ConstValuesRef control, int levels, Scalar* out,
                          const Progress& progress = {});

/// Unit normals at these vertices, V'-by-3 as points, and at the corners of all faces' grids, those of holes among
/// them, in the order of the tessellation. Through the connectivity of the refined mesh: some 200 bytes of memory a
/// vertex.
LimitNormals butterfly_grid_normals(const Topology& base, const Scheme& scheme, ConstValuesRef points, int levels);

}  // namespace batten
