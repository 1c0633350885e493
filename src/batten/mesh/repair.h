/// \file A mesh that no surface can be made of, mended into one that Topology accepts; every change is told.
///
/// In this order:
///   1. faces that name no vertex, or a vertex that is not finite, are dropped; vertices repeated within a face are
///      removed, a face that touches itself becomes several, one of fewer than three vertices is dropped; faces with
///      the vertices of an earlier one, in whatever direction, are dropped
///   2. edges of more than two faces are split: faces of one piece stay together, then the pair that is flattest, each
///      with its own edge; faces left over get a boundary
///   3. faces are reversed where neighbours disagree: the smaller part of a component, or, where that closes a solid,
///      so that all normals point outwards; what no choice brings to agree (a Moebius strip) is cut open
///   4. vertices that join several fans of faces get a copy a fan
///   5. boundaries are welded where their edges lie on each other, if the result stays a surface
///   6. vertices without a face and tags on what is gone are dropped
///
/// Nothing else is touched: faces and vertices keep their order, copies of vertices come last, and creases, corners,
/// holes, groups and attributes are carried along. A mesh without such faults comes back as it was, bit for bit; so
/// repairing twice is repairing once.
#pragma once
#include <string>
#include <vector>

#include "batten/mesh/mesh.h"

namespace batten {

/// What was done, in the words of the list above.
enum class RepairKind {
  BadFaces,          ///< dropped: they name no vertex, or one that is not finite
  DegenerateFaces,   ///< dropped: fewer than three different vertices
  SimplifiedFaces,   ///< repeated vertices removed, or split where the face touched itself
  RepeatedFaces,     ///< dropped: the vertices of an earlier face
  SplitEdges,        ///< edges of more than two faces, given to each pair of faces
  CutEdges,          ///< edges where a non-orientable piece was cut open
  ReversedFaces,     ///< their vertices in the other direction
  SplitVertices,     ///< vertices of several fans of faces, copied for each
  WeldedVertices,    ///< vertices joined to an earlier one at the same place
  IsolatedVertices,  ///< dropped: no face uses them (any more)
  DroppedTags        ///< creases, corners and holes on what does not exist (any more)
};

/// Everything of one kind that was changed.
struct RepairChange {
  RepairKind kind;
  Index count = 0;              ///< how many faces, vertices, edges or tags
  std::vector<Index> elements;  ///< all of them, as the input numbers them; two vertices an edge; empty for tags
  std::string text;             ///< a sentence with the count and the first few
};

/// What may be changed beyond what must be.
struct RepairOptions {
  /// How near vertices must be to be welded, of the bounding box's diagonal. 0: equal coordinates; below 0: no welding.
  double weld = 0.0;
};

/// The repaired mesh, and where its elements come from.
struct RepairResult {
  Mesh mesh;
  std::vector<RepairChange> changes;  ///< in the order above; empty: the mesh is the input
  Buffer<Index> vertex_sources;       ///< the input vertex of each vertex
  Buffer<Index> face_sources;         ///< the input face of each face
  Buffer<Index> vertex_targets;       ///< of each input vertex the first vertex it became or was welded to; -1: dropped
  Buffer<Index> face_targets;         ///< of each input face the first face it became; -1: dropped
};

/// The repaired mesh is accepted by Topology (it may have no face left).
/// Throws Error(BadShape) where the arrays do not fit each other, Error(TooLarge), Error(BadArgument) for a weld that
/// is not finite or over 1, Error(Cancelled). O(H log H).
RepairResult repair(const Mesh& mesh, const RepairOptions& options = {}, const Progress& progress = {});

/// A word for a program: "welded-vertices" and so on.
std::string repair_word(RepairKind kind);

}  // namespace batten
