/// \file What keeps a mesh from having a surface, named element by element.
#pragma once
#include <string>
#include <vector>

#include "batten/error.h"
#include "batten/mesh/mesh.h"

namespace batten {

struct MeshProblem {
  ErrorCode kind;
  std::string message;  ///< names the element and says what to do
};

/// The problems of a mesh, kind by kind in the order of ErrorCode's causes (offsets, indices, numbers, faces, edges,
/// vertices, tags), at most `limit` a kind. Empty exactly when Topology accepts the mesh. O(H log H).
std::vector<MeshProblem> check(const Mesh& mesh, std::size_t limit = 1);

}  // namespace batten
