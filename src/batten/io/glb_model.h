/// \file A glTF file as tinygltf reads it.
#pragma once
#include <tiny_gltf.h>

#include <string>

#include "batten/io/source.h"

namespace batten::io {

/// Extensions that pack meshes.
inline constexpr const char* kGltfPackings[] = {"KHR_draco_mesh_compression", "EXT_meshopt_compression"};

/// A packed mesh is refused by the name of its packing, which an export option of the other program turns off. Throws
/// Error(BadFile).
[[noreturn]] void refuse_packed(const std::string& name, const std::string& packing);

/// Images are not decoded: those in the text are kept as they are, those in buffers and files stay there. Throws
/// Error(BadFile, TooLarge).
tinygltf::Model load_gltf(const Source& source);

}  // namespace batten::io
