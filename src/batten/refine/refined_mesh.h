/// \file A whole mesh refined: its points, its attributes, its groups.
#pragma once
#include "batten/mesh/mesh.h"
#include "batten/mesh/topology.h"
#include "batten/scheme/scheme.h"

namespace batten {

/// A mesh and its connectivity.
struct RefinedMesh {
  Topology topology;
  Mesh mesh;  ///< the same connectivity, with points and attributes
};

/// One step for an attribute at corners, linear within each face (OpenSubdiv's FVAR_LINEAR_ALL, USD's
/// faceVaryingLinearInterpolation = "all"): a seam stays a seam, and nothing leaves the range of its face's corners.
/// Rows of the result: those of the attribute, then one an edge (two where its sides differ), then, for Catmull-Clark,
/// one a face. A new corner that depends on a corner without a row has none. O(H k). `attribute` is per corner of the
/// topology's mesh; throws Error(BadShape) where it has not one row number per corner.
Attribute refine_at_corners(const Topology& topology, SchemeKind kind, const Attribute& attribute);

/// One step for an attribute at corners under scheme.face_varying: linear as above, or by FaceVaryingSurface
/// (refine/face_varying.h). Then the attribute's own rows change, and a face with a corner that has no row has none at
/// all. Throws what either does.
Attribute refine_at_corners(const Topology& topology, const Scheme& scheme, const Attribute& attribute);

/// One step under CarryRule::Midpoint: V-by-k values at the vertices, then, in Refinement's order, the means of the
/// edges' ends and, for Catmull-Clark, of the faces' corners. O(H k). Throws Error(BadShape, Cancelled).
Values refine_midpoints(const Topology& topology, SchemeKind kind, ConstValuesRef values,
                        const Progress& progress = {});

/// Groups after one step: they begin where the children of their faces do.
std::vector<Group> refine_groups(const Topology& topology, SchemeKind kind, std::vector<Group> groups);

/// `levels` steps for a mesh and its topology. Points follow the scheme, attributes at the vertices their CarryRule,
/// attributes at corners scheme.face_varying; groups follow their faces, creases, corners and holes are the refined
/// ones, the boundary's holes included (with_surface_holes); normals are dropped: control points have none.
/// Throws what Refinement throws, and Error(BadArgument) for negative levels.
RefinedMesh refine_mesh(const Topology& topology, const Scheme& scheme, const Mesh& control, int levels,
                        const Progress& progress = {});

}  // namespace batten
