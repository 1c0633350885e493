/// \file The faces grouped by material.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "batten/mesh/mesh.h"

namespace batten::io {

/// The faces of one material, as ascending ranges [first, second).
struct FaceSet {
  std::string name;  ///< the name after OBJ's usemtl; empty for the faces before the first usemtl
  std::vector<std::pair<Index, Index>> ranges;
};

/// Every face belongs to exactly one set. The sets are in the order of their first faces, and none is empty.
std::vector<FaceSet> faces_by_material(const Mesh& mesh);

}  // namespace batten::io
