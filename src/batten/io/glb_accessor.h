/// \file The numbers of a glTF file.
#pragma once
#include <tiny_gltf.h>

#include <string>

#include "batten/types.h"

namespace batten::io {

/// The rows of an accessor as doubles: whole numbers as they are, those marked `normalized` as fractions in [0, 1] or
/// [-1, 1]; sparse rows replaced. `name` is the file's. Throws Error(BadFile) for anything that the buffers do not
/// hold, and if `columns` (0: any) is not the number of columns.
Values read_accessor(const std::string& name, const tinygltf::Model& model, int accessor, int columns);

}  // namespace batten::io
