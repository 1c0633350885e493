/// \file What is known of how a mesh's materials look, from the files that its material libraries name.
#pragma once
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "batten/mesh/mesh.h"

namespace batten::io {

/// How the faces of a group `usemtl` look.
struct Material {
  std::array<double, 4> color{1.0, 1.0, 1.0, 1.0};  ///< base colour (sRGB) and opacity, in [0, 1]; multiplies the image
  std::string texture;                              ///< path of an image; of one in memory its name; may be empty
  std::shared_ptr<const std::string> image;         ///< the bytes of an image in memory, or null
};

using Materials = std::map<std::string, Material>;

/// True for names such as "wood.png". A group `usemtl` of such a name shows that image, unless a library says
/// otherwise.
bool is_image_name(const std::string& name);

/// The materials of the mesh's groups by name, as its libraries (OBJ's material files, or glTF files that the mesh was
/// read from) describe them. Paths start in the folder of `file`. What is in no library, or in one that cannot be read,
/// is missing.
Materials find_materials(const std::string& file, const Mesh& mesh);

/// True for the name of a glTF file as a library.
bool is_gltf_library(const std::string& library);

/// Adds the materials of an OBJ material file with this text: the colour Kd, the opacity d (or 1 - Tr) and the image
/// map_Kd. Of several materials of one name the first counts. `path` is the file's.
void read_obj_materials(const std::string& path, std::string_view text, Materials& materials);

/// The name, in the folder of `path`, of the material file that an OBJ file gets where a glTF file says how the mesh's
/// materials look: `bracket.mtl` for `bracket.obj`. Empty where none does, or where no file can stand beside the OBJ.
std::string obj_material_file(const std::string& path, const Mesh& mesh);

/// Writes that file, if there is one, and beside it the images that the glTF file holds. Throws Error(FileNotWritable).
void write_obj_materials(const std::string& path, const Mesh& mesh);

/// The first `most` bytes of a file that another file names; nothing if it is no regular file, or cannot be read.
std::optional<std::string> named_file(const std::string& path, std::size_t most);

/// "image/png" or "image/jpeg", by the first bytes; otherwise empty.
std::string image_type(std::string_view bytes);

/// The bytes of a material's PNG or JPEG, from memory or from its file; null if there is none.
std::shared_ptr<const std::string> load_image(const Material& material);

/// True if load_image() would find an image. Reads a few bytes.
bool has_image(const Material& material);

}  // namespace batten::io
