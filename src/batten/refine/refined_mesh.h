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

/// Groups after one step: they begin where the children of their faces do.
std::vector<Group> refine_groups(const Topology& topology, SchemeKind kind, std::vector<Group> groups);

/// `levels` steps for a mesh and its topology. Points and attributes at the vertices follow the scheme, attributes at
/// corners are interpolated linearly, groups follow their faces, creases, corners and holes are the refined ones, the
/// boundary's holes included (with_surface_holes); normals are dropped: control points have none.
/// Throws what Refinement throws, and Error(BadArgument) for negative levels.
RefinedMesh refine_mesh(const Topology& topology, const Scheme& scheme, const Mesh& control, int levels,
                        const Progress& progress = {});

}  // namespace batten
