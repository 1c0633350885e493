/// \file One Catmull-Clark step on some components of a mesh, the others left as they are.
#pragma once
#include <vector>

#include "batten/mesh/mesh.h"
#include "batten/mesh/topology.h"
#include "batten/scheme/scheme.h"

namespace batten {

/// The connectivity of a mesh on some components of which one step of refinement acts, and what hangs on it. Since
/// components do not touch each other, the surface of either is what it was.
///
/// Vertex i of the parent is vertex i here; then come the vertices that the step adds, in the order in which
/// Refinement has them. Faces keep the parent's order; the children of a refined face stand in its place. O(H).
class PartRefinement {
 public:
  /// child: Refinement's child of the whole topology under Catmull-Clark. is_refined: a flag a face, the same on all
  /// faces of a component.
  PartRefinement(const Topology& topology, const Topology& child, Buffer<std::uint8_t> is_refined);

  const Topology& topology() const { return part_; }

  /// Rows of the values before the step on vertices that are left as they are, and of those after it elsewhere.
  /// before: V-by-k; after: one row for each vertex of the child. Throws Error(BadShape).
  Values choose(ConstValuesRef before, ConstValuesRef after) const;

  /// The attribute at corners, refined as refine_at_corners does under the scheme where the step acts; without rows
  /// that no corner has there, except the attribute's own, which come first. Throws what refine_at_corners does.
  Attribute at_corners(const Scheme& scheme, const Attribute& attribute) const;

  /// Groups begin where the faces do that stand for their first face.
  std::vector<Group> groups(std::vector<Group> groups) const;

 private:
  void place_faces();
  void place_vertices(const Topology& child);
  Mesh tagged_mesh(const Topology& child) const;

  Topology parent_;
  Buffer<std::uint8_t> is_refined_;
  Buffer<Index> first_face_;  ///< of each face of the parent, and the count at the end
  Buffer<Index> sources_;     ///< of each vertex, the child's
  Buffer<Index> places_;      ///< of each vertex of the child; -1: none
  Topology part_;
};

}  // namespace batten
