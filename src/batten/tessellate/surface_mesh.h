/// \file The limit surface as an ordinary mesh, for programs and formats that know no subdivision surfaces.
#pragma once
#include "batten/mesh/mesh.h"
#include "batten/mesh/topology.h"
#include "batten/scheme/scheme.h"

namespace batten {

/// The vertices of a Tessellator of so many levels, in its order (tessellate/tessellator.h), on the limit surface:
/// vertex i of the control mesh is vertex i. With 0 levels the faces are those of the control mesh. Attributes at the
/// vertices follow their CarryRule, by the scheme as the points do, or linearly; attributes at corners follow
/// scheme.face_varying, where all of a face's corners have a row; a group has the children of its faces. Holes are left
/// out, and so are the tags: these points are on the surface, they are not control points of it.
///
/// "normal" holds the limit normals at the vertices (zero where there is none), and where creases give a vertex several
/// also at the corners: rows of their own for the sides that differ. Normals of the control mesh are dropped.
///
/// Time and memory O(4^levels H); besides the result some 120 bytes a face of the control mesh, under the Butterflies
/// 200 bytes a vertex of the result. Throws Error: BadArgument (negative levels, more than 15), BadShape, NotFinite,
/// TooLarge, NotTriangles, Cancelled.
Mesh surface_mesh(const Topology& topology, const Scheme& scheme, const Mesh& control, int levels,
                  const Progress& progress = {});

/// As many levels as leave a control mesh with at most so many faces, but no more than `most`.
int levels_within(const Topology& topology, double faces, int most);

/// The levels that make some 400,000 faces of a control mesh, at most 5: enough for a picture of the whole surface.
int picture_levels(const Topology& topology);

}  // namespace batten
