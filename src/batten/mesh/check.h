/// \file The reasons why a mesh has no surface, with the elements concerned.
#pragma once
#include <string>
#include <vector>

#include "batten/error.h"
#include "batten/mesh/mesh.h"

namespace batten {

/// One kind of problem of a mesh.
struct MeshProblem {
  ErrorCode kind;
  std::size_t count = 0;              ///< how many faces, edges, vertices, components or tags
  std::vector<std::string> messages;  ///< for the first ones; each message names the element and says what to do
};

/// The problems of a mesh by kind, in the order of ErrorCode's causes (offsets, indices, numbers, faces, edges,
/// vertices, tags), each with at most `limit` messages. Edges and vertices are examined without the faces that are
/// wrong by themselves. The result is empty exactly when Topology accepts the mesh. O(H log H): a second for a million
/// quads. Throws Error(Cancelled); the callback is called between the kinds.
std::vector<MeshProblem> check(const Mesh& mesh, std::size_t limit = 1, const Progress& progress = {});

}  // namespace batten
