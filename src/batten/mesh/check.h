/// \file What keeps a mesh from having a surface, named element by element.
#pragma once
#include <string>
#include <vector>

#include "batten/error.h"
#include "batten/mesh/mesh.h"

namespace batten {

/// One thing that is wrong with a mesh.
struct MeshProblem {
  ErrorCode kind;
  std::size_t count = 0;              ///< of faces, edges, vertices, components or tags
  std::vector<std::string> messages;  ///< of the first of them: each names the element and says what to do
};

/// The problems of a mesh, kind by kind in the order of ErrorCode's causes (offsets, indices, numbers, faces, edges,
/// vertices, tags), with the messages of at most `limit` a kind. Edges and vertices are looked at without the faces
/// that are wrong in themselves. Empty exactly when Topology accepts the mesh. O(H log H): a second a million quads.
/// Throws Error(Cancelled): the callback is asked between the kinds.
std::vector<MeshProblem> check(const Mesh& mesh, std::size_t limit = 1, const Progress& progress = {});

}  // namespace batten
