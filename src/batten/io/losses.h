/// \file What a file format does not keep of a mesh.
#pragma once
#include <string>
#include <vector>

#include "batten/io/io.h"

namespace batten {

/// The parts of the mesh that a file written by write_mesh(path, mesh, options) lacks, in words such as "creases",
/// "texture coordinates at corners" or "attribute 'weight'"; empty if reading the file gives all of them. What a mesh
/// has no more than a reader assumes anyway is no loss, such as the boundary rule EdgeOnly or a group `s off`. Floats
/// instead of doubles count only where they hold fewer than six digits of the bounding box, which is the case in STL
/// far from the origin. Throws Error(UnknownFormat). Cost: O(V + corners).
std::vector<std::string> find_losses(const std::string& path, const Mesh& mesh, const WriteOptions& options = {});

}  // namespace batten
