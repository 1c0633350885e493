/// \file Repairs a mesh that has no surface, so that Topology accepts it, and reports every change.
///
/// The steps, in this order:
///   1. faces that name no vertex, or a vertex that is not finite, are dropped; vertices repeated within a face are
///      removed, a face that touches itself becomes several, and one of fewer than three vertices is dropped;
///      faces with the vertices of an earlier one, in either direction, are dropped
///   2. edges of more than two faces are split: faces of one piece stay together, then the flattest pair; each pair
///      gets its own edge, and faces left over get a boundary
///   3. faces are reversed where neighbours disagree: the smaller part of a component, or, where that closes a solid,
///      so that all normals point outwards; a component that cannot be oriented (a Moebius strip) is cut open
///   4. vertices that join several fans of faces get a copy for each fan
///   5. boundaries are welded where their edges coincide, if the result is still a surface
///   6. vertices without a face and tags on missing elements are dropped
///
/// Everything else is kept: faces and vertices keep their order, copies of vertices come last, and creases, corners,
/// holes, groups and attributes are carried along. A mesh without these faults is returned unchanged, bit for bit, and
/// repairing a repaired mesh changes nothing.
#pragma once
#include <string>
#include <vector>

#include "batten/mesh/mesh.h"

namespace batten {

/// The kinds of changes, named after the steps above.
enum class RepairKind {
  BadFaces,          ///< dropped: they name no vertex, or one that is not finite
  DegenerateFaces,   ///< dropped: fewer than three different vertices
  SimplifiedFaces,   ///< repeated vertices were removed, or the face was split where it touched itself
  RepeatedFaces,     ///< dropped: the vertices of an earlier face
  SplitEdges,        ///< edges of more than two faces, given to each pair of faces
  CutEdges,          ///< edges where a non-orientable piece was cut open
  ReversedFaces,     ///< reversed faces
  SplitVertices,     ///< vertices of several fans of faces, copied for each
  WeldedVertices,    ///< vertices joined to an earlier one at the same place
  IsolatedVertices,  ///< dropped: no face uses them
  DroppedTags        ///< dropped creases, corners and holes on missing elements
};

/// All changes of one kind.
struct RepairChange {
  RepairKind kind;
  Index count = 0;              ///< how many faces, vertices, edges or tags
  std::vector<Index> elements;  ///< all of them in the input's numbers, two vertices for an edge; empty for tags
  std::string text;             ///< a sentence with the count and the first few elements
};

/// Optional changes.
struct RepairOptions {
  /// The greatest distance at which vertices are welded, relative to the bounding box's diagonal. 0: equal coordinates;
  /// below 0: no welding.
  double weld = 0.0;
};

/// The repaired mesh and the origin of its elements.
struct RepairResult {
  Mesh mesh;
  std::vector<RepairChange> changes;  ///< in the order of the steps; empty if the mesh is the input
  Buffer<Index> vertex_sources;       ///< the input vertex of each vertex
  Buffer<Index> face_sources;         ///< the input face of each face
  Buffer<Index> vertex_targets;       ///< for each input vertex, the first one it became or was welded to, or -1
  Buffer<Index> face_targets;         ///< for each input face, the first face it became, or -1
};

/// Topology accepts the repaired mesh, which may have no faces left. O(H log H).
/// Throws Error(BadShape) if the arrays do not fit each other, Error(TooLarge), Error(BadArgument) for a weld that is
/// not finite or over 1, Error(Cancelled).
RepairResult repair(const Mesh& mesh, const RepairOptions& options = {}, const Progress& progress = {});

/// The kind's name for programs, such as "welded-vertices".
std::string repair_word(RepairKind kind);

}  // namespace batten
