/// \file Where the vertices of a tessellation lie on the surface, and how sharp it is there.
#pragma once
#include <span>
#include <vector>

#include "batten/patch/surface_place.h"
#include "batten/tessellate/tessellator.h"

namespace batten {

/// The place of each vertex in a face of Tessellator::base(): a base vertex in the face where its fan of half-edges
/// starts, a vertex inside an edge in the face of the edge's lower half-edge. One without a face has face -1. O(V').
Buffer<SurfacePlace> vertex_places(const Tessellator& tessellator);

/// Sharpness as a field to be drawn: vertex_sharpnesses() at the vertices of the control mesh, the creases' own along
/// them, and zero off them from a quarter of a face on, linear between. topology: of the control mesh. V' numbers,
/// O(V').
Scalars sharpness_field(const Topology& topology, const Tessellator& tessellator);

/// A crease as the tessellation's vertices along it.
struct CreaseCurve {
  std::vector<Index> vertices;
  double sharpness;  ///< crease_sharpness()
};

/// The creases of the control mesh, one for each of its sharp edges inside the mesh, in their order.
/// O(E + the vertices along them).
std::vector<CreaseCurve> crease_curves(const Topology& topology, const Tessellator& tessellator);

/// For each vertex of the tessellation its number after as many refinement steps. levels: the connectivities from the
/// tessellation's base, levels[0], up to its finest level (refine/refinement.h). O(V' levels), threaded.
Buffer<Index> refinement_order(const Tessellator& tessellator, std::span<const Topology> levels);

}  // namespace batten
