/// \file The normals that a surface shall have at its targets.
///
/// Wanted normals are a V-by-3 matrix: row i is a unit vector for vertex i, or zero where none is wanted.
#pragma once
#include <string>

#include "batten/mesh/topology.h"

namespace batten {

/// Rows of any length become unit vectors; zero rows, and those too short to have a direction, stay zero. O(V). Throws
/// Error(BadShape) for other than three columns, Error(NotFinite) naming the row.
Values wanted_normals(ConstValuesRef directions);

/// Those that a mesh states: its attribute "normal" (OBJ's vn, PLY's nx ny nz); where corners of a vertex differ, their
/// mean. `name` stands for the mesh in messages. Throws Error(BadArgument) where it states none, Error(NotFinite)
/// naming the vertex.
Values stated_wanted_normals(const Mesh& mesh, const std::string& name = "the mesh");

/// Estimates from the targets themselves: angle_weighted_normals() (mesh/vertex_normals.h). On a mesh that samples a
/// smooth surface they are off by O(h^2) where the vertices are spread evenly, by O(h) elsewhere. points: V-by-3. O(H).
Values estimated_wanted_normals(const Topology& topology, ConstValuesRef points);

}  // namespace batten
