/// \file Values at corners as a surface of their own: that of the mesh cut along its seams.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "batten/mesh/mesh.h"
#include "batten/mesh/topology.h"
#include "batten/progress.h"
#include "batten/scheme/scheme.h"

namespace batten {

/// The control mesh of an attribute at corners: the faces and half-edges of the mesh itself, with a vertex for each
/// value. Refinement, LimitMatrix, Tessellator and other operators take it as they take any mesh, and half-edge h of
/// what they make of it stands for half-edge h of what they make of the mesh.
struct FaceVaryingSurface {
  Topology topology;
  Scheme scheme;  ///< the mesh's, with BoundaryRule::EdgeOnly
  Values values;  ///< control values, a row for each vertex of `topology`
  /// One flag a face: 1 where the face has no values because one of its corners has no row. Empty: all have values.
  Buffer<std::uint8_t> without_values;
  /// Vertices that stand for one row at one vertex of the mesh, where it comes back beyond a seam: a corner, and so
  /// equal at every level. Pairs of a vertex and the first of its row.
  std::vector<std::pair<Index, Index>> returning;

  /// One step. Throws what Refinement does.
  FaceVaryingSurface refined(const Progress& progress = {}) const;

  /// The values as an attribute of the mesh that has these half-edges. Faces without values have no rows. What cuts it
  /// again finds the same seams and corners.
  Attribute attribute(const std::string& name) const;
};

/// Cuts the mesh along the edges whose two faces have different rows at either end, and makes those values infinitely
/// sharp that scheme.face_varying keeps. Creases, corners and holes of the mesh act on the values too. The rules are
/// OpenSubdiv's (key OSD), to rounding, but for three cases. Chaikin's rule averages the sharpness of creases on one
/// side of a seam only; OpenSubdiv's averages all at the vertex. Where a semi-sharp edge makes two values corners
/// (CornersPlus1 and 2), both become smooth at once; in OpenSubdiv one is a level late if the seam is semi-sharp too.
/// A row that comes back at a vertex beyond a seam is a corner; OpenSubdiv takes some of those for values apart (None).
///
/// Vertices: row i of the attribute is vertex i; then come those of rows that serve several places, in the order of the
/// mesh's vertices. Holes are those of `topology`: with_surface_holes() adds those of a boundary rule. O(H + values).
/// Throws Error: BadShape (not one row number per corner), IndexOutOfRange, NotFinite, TooLarge.
FaceVaryingSurface face_varying_surface(const Topology& topology, const Scheme& scheme, const Attribute& attribute);

}  // namespace batten
