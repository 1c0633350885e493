/// \file The body of a binary PLY file.
#pragma once
#include <vector>

#include "batten/io/ply_targets.h"

namespace batten::io {

/// Keeps the values of faces in `faces`. Refuses counts that the file cannot hold before memory is allocated. Throws
/// Fault.
void read_ply_binary(const Source& source, const PlyHeader& header, std::vector<PlyTargets>& targets,
                     PlyFaceValues& faces, Mesh& mesh);

}  // namespace batten::io
