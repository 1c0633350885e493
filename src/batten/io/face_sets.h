/// \file The faces by material.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "batten/mesh/mesh.h"

namespace batten::io {

/// Consecutive faces [first, second) of one name, in ascending ranges.
struct FaceSet {
  std::string name;  ///< as after OBJ's usemtl; empty for the faces before the first
  std::vector<std::pair<Index, Index>> ranges;
};

/// Every face belongs to one set; sets in the order of their first faces, none empty.
std::vector<FaceSet> faces_by_material(const Mesh& mesh);

}  // namespace batten::io
