/// \file The limit normals at the corners of a tessellation's faces, where a crease gives a vertex several.
#pragma once
#include "batten/mesh/mesh.h"
#include "batten/tessellate/tessellator.h"

namespace batten {

/// What has one normal for each side of its creases: a tessellation of a spline surface, and its normals at the
/// vertices as Tessellator::limit() gives them.
struct TessellatedNormals {
  const SurfacePatches& patches;                              ///< of Catmull-Clark or Loop
  Eigen::Ref<const Values, 0, Eigen::OuterStride<>> control;  ///< V-by-3; not copied
  const Tessellator& tessellator;
  const Buffer<Index>& face_rank;      ///< drawn base faces before each base face, -1 for one that is not drawn
  const Buffer<Index>& face_vertices;  ///< of Tessellator::faces()
  const Values& vertices;              ///< V'-by-3
};

/// The attribute "normal" at the corners: the rows of the vertices, then one row for each side of an infinitely sharp
/// edge, and each corner of a base face, whose normal differs from its vertex's. Without any such corner the attribute
/// has no corner rows. O(H) for the control mesh where it has creases, and O(4^levels) for each face beside one.
Attribute side_normals(const TessellatedNormals& surface);

}  // namespace batten
