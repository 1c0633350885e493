/// \file Edges of a triangle mesh that lie along sharp edges of the data.
#pragma once
#include "batten/fit/point_tree.h"
#include "batten/mesh/mesh.h"

namespace batten {

/// Turns edges between triangles so that the mesh lies nearer to the points: then its edges run along sharp edges of
/// the data and not across them. No turn changes the topology, folds a triangle over or leaves a valence above 12.
/// normals: of the points, of length 1. O(N + F) a round.
void turn_to_points(Mesh& mesh, const PointTree& points, const Points& normals);

/// Finds the edges of a triangle mesh, as creases of infinite sharpness, along which the data is sharp. Of the points
/// beside an edge two models are laid, a roof of two planes and a parabola, each straight along the edge; the edge is
/// sharp where the roof turns by 35 degrees or more and leaves a third of what the parabola leaves. Edges with less
/// evidence join where they carry the line on; lines of less than four edges or eight spacings are left out, and so are
/// short spurs. normals: of the points, of length 1, without the sides of sharp edges mixed (fit/sharp_normals.h).
/// spacing: of the points. O(E), threaded.
std::vector<Crease> find_sharp_edges(const Mesh& mesh, const PointTree& points, const Points& normals, double spacing);

/// Takes away the creases of a mesh that are single spurs at a line, or lines of less than four edges or eight
/// spacings.
void keep_lines(Mesh& mesh, double spacing);

}  // namespace batten
