/// OBJ's material files for materials that a glTF file describes.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>

#include "batten/io/file_paths.h"
#include "batten/io/materials.h"
#include "batten/output.h"

namespace batten::io {

namespace {

/// Six digits: more than the 8 bits of a screen or the floats of a glTF file mean.
std::string number_text(double value) {
  char digits[32];
  const int count = std::snprintf(digits, sizeof(digits), "%.6g", value);
  return {digits, static_cast<std::size_t>(count)};
}

/// Images in memory, each written once beside the material file: `bracket-1.png`.
class ImageFiles {
 public:
  explicit ImageFiles(const std::filesystem::path& base) : base_(base) {}

  /// The name of the image's file, relative to the folder; empty where it is neither PNG nor JPEG.
  std::string name_of(const std::shared_ptr<const std::string>& image) {
    const std::string type = image_type(*image);
    if (type.empty()) return "";
    std::string& name = names_[image.get()];
    if (!name.empty()) return name;
    const std::string file = base_.filename().string() + "-" + std::to_string(names_.size()) +
                             (type == "image/png" ? std::string(".png") : std::string(".jpg"));
    write_bytes((base_.parent_path() / file).string(), Buffer<unsigned char>(image->begin(), image->end()));
    return name = file;
  }

 private:
  std::filesystem::path base_;
  std::map<const std::string*, std::string> names_;
};

}  // namespace

std::string obj_material_file(const std::string& path, const Mesh& mesh) {
  if (is_special_target(path)) return "";
  const bool has_gltf = std::any_of(mesh.material_libraries.begin(), mesh.material_libraries.end(), is_gltf_library);
  if (!has_gltf || find_materials(path, mesh).empty()) return "";
  return std::filesystem::path(path).stem().string() + ".mtl";
}

void write_obj_materials(const std::string& path, const Mesh& mesh) {
  const std::string name = obj_material_file(path, mesh);
  if (name.empty()) return;
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  ImageFiles images(folder / std::filesystem::path(path).stem());
  std::string text;
  for (const auto& [material, look] : find_materials(path, mesh)) {
    text += "newmtl " + material + "\nKd";
    for (std::size_t k = 0; k < 3; ++k) text += " " + number_text(look.color[k]);
    text += "\n";
    if (look.color[3] < 1.0) text += "d " + number_text(look.color[3]) + "\n";
    std::string image = look.texture.empty() ? "" : name_in(path, look.texture);
    if (look.image != nullptr) image = images.name_of(look.image);
    if (!image.empty()) text += "map_Kd " + image + "\n";
  }
  write_bytes((folder / name).string(), Buffer<unsigned char>(text.begin(), text.end()));
}

}  // namespace batten::io
