/// \file Normals at the vertices of a mesh as it is: those that it states, and those that its faces suggest.
#pragma once
#include "batten/mesh/topology.h"

namespace batten {

/// The attribute "normal" as a row a vertex, of any length: at the vertices as it stands, at corners the sum over the
/// corners of a vertex, which lies between the sides of a crease. Those at corners count where a mesh has both. Zero
/// where it states none. V-by-3. O(corners).
Points stated_normals(const Mesh& mesh);

/// True if the mesh has an attribute "normal".
bool states_normals(const Mesh& mesh);

/// The unit normals of the faces around each vertex, weighted by their angles there, as a unit vector (key TW98); zero
/// where there is no face or they cancel. The angles make it independent of how flat parts are cut into faces. Holes
/// count too: they shape the surface. points: V-by-3. O(H).
Points angle_weighted_normals(const Topology& topology, ConstValuesRef points);

}  // namespace batten
