/// \file The closed mesh over the ends of a medial model's spokes.
#pragma once
#include <string>
#include <vector>

#include "batten/medial/medial_model.h"

namespace batten {

/// Which spoke ends at a vertex.
struct SpokeEnd {
  Index figure = -1;
  Index atom = -1;
  SpokeSide side = SpokeSide::Up;
};

/// The mesh of spoke ends, and the spokes in the order of its vertices.
struct MedialBoundary {
  /// Points are the spokes' ends. Attributes at the vertices: "medial" (k = 3: u, v, side; where every figure has
  /// coordinates) and "radius" (k = 1: the length of the spoke). A group `o` for each of several figures
  /// that has a name. The scheme is Catmull-Clark.
  Mesh mesh;
  std::vector<SpokeEnd> ends;  ///< V
  Points origins;              ///< V-by-3: where the spokes start
  Points directions;           ///< V-by-3: the unit vectors along the spokes, outward normals in Blum's sense
  Scalars radii;               ///< V: the lengths of the spokes
};

/// For each figure the faces of the sheet over the upward ends, the same faces turned over the downward ones, and along
/// the boundary of the sheet two strips of quads that meet in the ends of the crest spokes: closed, with outward faces
/// whichever way the sheet's faces turn. Vertices, figure by figure: the upward ends in the order of the atoms, the
/// downward ones, the crest in the order of MedialFigure::crest. Where a hinge opens two figures, a ring of quads, or
/// of quads and triangles where one opening has more vertices, joins them at the end of the faces, and vertices without
/// a face are left out. Throws what require_medial throws, and Error(IndexOutOfRange, BadArgument) for a hinge that
/// does not open a disk. O(atoms).
MedialBoundary medial_boundary(const MedialModel& model);

/// What messages call a spoke: the name of its atom and "up", "down" or "crest", as in "line 3, step 1, up".
std::string spoke_name(const MedialModel& model, const SpokeEnd& end);

/// The vertices where the two spokes of one atom end.
struct SpokePair {
  Index up = -1;
  Index down = -1;
};

/// Of each atom whose two ends are vertices, in the order of the upward ends. O(vertices).
std::vector<SpokePair> spoke_pairs(const MedialBoundary& boundary);

}  // namespace batten
