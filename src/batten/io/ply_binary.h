/// \file The body of a binary PLY file.
#pragma once
#include <vector>

#include "batten/io/ply_targets.h"

namespace batten::io {

/// Throws Fault. Counts that the file cannot hold are refused before anything is allocated.
void read_ply_binary(const Source& source, const PlyHeader& header, std::vector<PlyTargets>& targets, Mesh& mesh);

}  // namespace batten::io
