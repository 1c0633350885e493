/// \file The leaves of a forest as faces without T-junctions.
///
/// A leaf is a polygon: its corners and, where a neighbour is finer, the vertex in the middle of the side. Both sides
/// of every edge of these polygons have the same two vertices; all that is left is to cut each polygon by itself.
#pragma once
#include "batten/adaptive/cell_forest.h"

namespace batten {

/// Faces of three or four vertices each, counter-clockwise as the base's.
struct CellFaces {
  Index size = 3;                        ///< of every face
  Buffer<Index> vertices;                ///< `size` a face: the forest's, then those added
  Buffer<std::array<double, 2>> places;  ///< of each corner, in the base face
  Buffer<Index> cells;                   ///< one a face
  Buffer<SurfacePlace> added;            ///< vertices that the forest does not have
  Index count() const { return static_cast<Index>(cells.size()); }
};

/// Triangles. A corner between two finer neighbours is cut off; what is left is a fan from that vertex in the middle of
/// a side, or that corner where there is none, whose longest diagonal is shortest. points: a row a vertex of the
/// forest. O(cells), threaded.
CellFaces triangles_of(const CellForest& forest, const Points& points);

/// Quads only: polygons of n sides become n quads around their centre, each side is halved.
CellFaces quads_of(const CellForest& forest);

/// The leaves themselves. For a forest in which no neighbours differ.
CellFaces leaves_of(const CellForest& forest);

}  // namespace batten
