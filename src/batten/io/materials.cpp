#include "batten/io/materials.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <system_error>

#include "batten/io/file_paths.h"
#ifdef BATTEN_WITH_GLTF
#include "batten/io/glb_materials.h"
#endif

namespace batten::io {

namespace {

constexpr std::size_t kHead = 16;
constexpr std::size_t kLargest = std::size_t{1} << 30;
/// Far more than any material file has.
constexpr std::size_t kLargestLibrary = std::size_t{1} << 26;

std::string lower_extension(const std::string& name) {
  std::string extension = std::filesystem::path(name).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

void read_library(const std::string& path, Materials& materials) {
  if (is_gltf_library(path)) {
#ifdef BATTEN_WITH_GLTF
    read_gltf_materials(path, materials);
#endif
    return;
  }
  const std::optional<std::string> text = named_file(path, kLargestLibrary);
  if (text) read_obj_materials(path, *text, materials);
}

}  // namespace

bool is_image_name(const std::string& name) {
  static const std::set<std::string> extensions = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".tga", ".webp"};
  return extensions.count(lower_extension(name)) > 0;
}

bool is_gltf_library(const std::string& library) {
  const std::string extension = lower_extension(library);
  return extension == ".glb" || extension == ".gltf";
}

Materials find_materials(const std::string& file, const Mesh& mesh) {
  Materials known;
  const auto is_material = [](const Group& group) { return group.keyword == "usemtl"; };
  if (std::none_of(mesh.groups.begin(), mesh.groups.end(), is_material)) return known;
  for (const std::string& library : mesh.material_libraries) read_library(path_named_in(file, library), known);
  Materials used;
  for (const Group& group : mesh.groups) {
    if (!is_material(group) || used.count(group.name) > 0) continue;
    const auto found = known.find(group.name);
    if (found != known.end()) {
      used.insert(*found);
    } else if (is_image_name(group.name)) {
      used[group.name].texture = path_named_in(file, group.name);
    }
  }
  return used;
}

std::optional<std::string> named_file(const std::string& path, std::size_t most) {
  std::error_code error;
  if (path.empty() || !std::filesystem::is_regular_file(path, error)) return std::nullopt;
  const auto size = static_cast<std::size_t>(std::filesystem::file_size(path, error));
  std::ifstream file(path, std::ios::binary);
  if (error || !file) return std::nullopt;
  std::string bytes(std::min(size, most), '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return bytes;
}

std::string image_type(std::string_view bytes) {
  constexpr std::string_view kPng = "\x89PNG\r\n\x1A\n";
  constexpr std::string_view kJpeg = "\xFF\xD8\xFF";
  if (bytes.substr(0, kPng.size()) == kPng) return "image/png";
  return bytes.substr(0, kJpeg.size()) == kJpeg ? "image/jpeg" : "";
}

std::shared_ptr<const std::string> load_image(const Material& material) {
  if (!has_image(material)) return nullptr;
  if (material.image != nullptr) return material.image;
  std::optional<std::string> bytes = named_file(material.texture, kLargest);
  return bytes ? std::make_shared<const std::string>(std::move(*bytes)) : nullptr;
}

bool has_image(const Material& material) {
  if (material.image != nullptr) return !image_type(*material.image).empty();
  const std::optional<std::string> head = named_file(material.texture, kHead);
  return head && !image_type(*head).empty();
}

}  // namespace batten::io
