/// \file The quads between the inside and the outside of a grid.
#pragma once
#include "batten/fit/value_grid.h"
#include "batten/mesh/mesh.h"

namespace batten {

/// A closed manifold of quads around the nodes with positive numbers: one vertex for each sheet of the surface in a
/// cell, at the mean of the places where the sheet crosses the cell's edges (linearly), one quad for each edge that is
/// crossed (Nielson 2004, key N04). Sheets meet on the faces of cells by the asymptotic decider (Nielson and Hamann
/// 1991, key NH91), but for faces where that would join two cells by the same edge twice: there the other choice is
/// made (Wenger 2013, key W13), so that no edge has more than two faces. Normals point from positive numbers to others.
/// Nodes on the border of the grid count as outside. O(nodes).
Mesh dual_contour(const ValueGrid& grid);

}  // namespace batten
