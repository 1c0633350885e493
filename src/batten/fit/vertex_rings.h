/// \file A closed triangle mesh as the rings of its vertices, from which vertices are taken and put back.
#pragma once
#include <cstddef>
#include <vector>

#include "batten/mesh/mesh.h"

namespace batten {

/// Vertices around one, counter-clockwise as seen from outside.
using Ring = std::vector<Index>;

/// A vertex that is gone, and its ring from the vertex that it went to.
struct RemovedVertex {
  Index vertex;
  Ring ring;
};

/// The ring of each vertex.
class VertexRings {
 public:
  /// mesh: triangles that Topology accepts, without boundary.
  explicit VertexRings(const Mesh& mesh);

  /// Empty where the vertex is gone.
  const Ring& of(Index vertex) const { return rings_[vertex]; }

  /// True where the surface stays a manifold (the link condition, Dey and others 1999, key DEGN99) and no vertex has
  /// more than so many neighbours then.
  bool can_collapse(Index gone, Index kept, std::size_t most) const;
  /// The edge between both shrinks to `kept`.
  RemovedVertex collapse(Index gone, Index kept);
  /// Undoes the last collapse().
  void restore(const RemovedVertex& removed);

 private:
  std::vector<Ring> rings_;
};

/// Takes vertices away until four are left, those first without which the shape changes least (Garland and Heckbert
/// 1997, key GH97), and returns them in that order.
std::vector<RemovedVertex> remove_to_tetrahedron(const Mesh& mesh, VertexRings& rings);

}  // namespace batten
