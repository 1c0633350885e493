/// \file Turns the leaves of a forest into faces without T-junctions.
///
/// A leaf is a polygon of its corners and, where a neighbour is finer, the vertex in the middle of the side. Both sides
/// of each edge of these polygons have the same two vertices, so each polygon can be cut by itself.
#pragma once
#include "batten/adaptive/cell_forest.h"

namespace batten {

/// Faces of three or four vertices each, counter-clockwise like the base's.
struct CellFaces {
  Index size = 3;                        ///< the number of corners of each face
  Buffer<Index> vertices;                ///< `size` for each face: the forest's vertices, then the added ones
  Buffer<std::array<double, 2>> places;  ///< of each corner, in the base face
  Buffer<Index> cells;                   ///< one for each face
  Buffer<SurfacePlace> added;            ///< the places of vertices that the forest does not have
  Index count() const { return static_cast<Index>(cells.size()); }
};

/// The number of faces of `size` corners that is asked for, or that a mesh can have: an Index counts its corners.
Index most_faces(Index asked, Index size);

/// Cuts polygons into triangles. A corner between two finer neighbours is cut off. The rest is a fan from the middle of
/// a side, or from a corner if there is no such vertex, chosen so that the longest diagonal is shortest. points: a row
/// for each vertex of the forest. O(cells), threaded.
CellFaces triangles_of(const CellForest& forest, const Points& points);

/// Cuts polygons into quads: each polygon of n sides becomes n quads around its centre, and each side is halved.
CellFaces quads_of(const CellForest& forest);

/// The leaves themselves, for a forest in which neighbours do not differ in level.
CellFaces leaves_of(const CellForest& forest);

}  // namespace batten
