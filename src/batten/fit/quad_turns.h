/// \file Quads made more regular by turning the edges between them.
#pragma once
#include "batten/mesh/mesh.h"

namespace batten {

/// How far a quad is from a flat rectangle: the greatest |cosine| of a corner or one less the cosine between the
/// normals of two neighbouring corners, which is above 1 where it folds over. corners: four vertices in a circle.
double quad_badness(const Points& points, const Index* corners);

/// Turns edges between two quads to the next pair of corners of their hexagon as long as valences come nearer to 4 (3
/// edges on boundaries) or quads nearer to rectangles. Other faces stay. `mesh`: a mesh that Topology accepts; so it
/// does the result. O(H) for each of at most 40 rounds.
void turn_quad_edges(Mesh& mesh);

}  // namespace batten
