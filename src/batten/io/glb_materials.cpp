#include "batten/io/glb_materials.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include "batten/error.h"
#include "batten/io/file_paths.h"
#include "batten/io/glb_model.h"

namespace batten::io {

namespace {

/// "my%20wood.png" is my wood.png.
std::string without_escapes(const std::string& uri) {
  const auto digit = [](char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
  };
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool escape = uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0;
    text += escape ? static_cast<char>(16 * digit(uri[i + 1]) + digit(uri[i + 2])) : uri[i];
    if (escape) i += 2;
  }
  return text;
}

/// Control characters have no place in names.
std::string as_name(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 32; }, ' ');
  return text;
}

}  // namespace

double linear_from_srgb(double value) {
  const double clamped = std::clamp(value, 0.0, 1.0);
  return clamped <= 0.04045 ? clamped / 12.92 : std::pow((clamped + 0.055) / 1.055, 2.4);
}

double srgb_from_linear(double value) {
  const double clamped = std::clamp(value, 0.0, 1.0);
  return clamped <= 0.0031308 ? 12.92 * clamped : 1.055 * std::pow(clamped, 1.0 / 2.4) - 0.055;
}

std::string gltf_material_name(const tinygltf::Model& model, int material) {
  if (material < 0 || static_cast<std::size_t>(material) >= model.materials.size()) return "";
  const std::string& name = model.materials[static_cast<std::size_t>(material)].name;
  return name.empty() ? "material " + std::to_string(material) : as_name(name);
}

Material GltfMaterials::material(int number) {
  Material found;
  const tinygltf::PbrMetallicRoughness& look = model_.materials[static_cast<std::size_t>(number)].pbrMetallicRoughness;
  for (std::size_t k = 0; k < std::min<std::size_t>(look.baseColorFactor.size(), 4); ++k) {
    const double value = look.baseColorFactor[k];
    found.color[k] = k < 3 ? srgb_from_linear(value) : std::clamp(value, 0.0, 1.0);
  }
  const tinygltf::Image* const image = find_image(number);
  if (image == nullptr) return found;
  if (!image->uri.empty()) {
    found.texture = path_named_in(name_, as_name(without_escapes(image->uri)));
    return found;
  }
  found.image = bytes_of(*image);
  found.texture = as_name(image->name);
  return found;
}

bool GltfMaterials::has_look(int number, bool colored) const {
  if (number < 0 || static_cast<std::size_t>(number) >= model_.materials.size()) return false;
  const tinygltf::PbrMetallicRoughness& look = model_.materials[static_cast<std::size_t>(number)].pbrMetallicRoughness;
  const double grey = colored ? 1.0 : 0.8;
  return look.baseColorTexture.index >= 0 || look.baseColorFactor != std::vector<double>{grey, grey, grey, 1.0};
}

void read_gltf_materials(const std::string& path, Materials& materials) {
  constexpr std::size_t kLargest = std::numeric_limits<unsigned int>::max();
  const std::optional<std::string> bytes = named_file(path, kLargest);
  if (!bytes) return;
  try {
    const tinygltf::Model model = load_gltf({path, *bytes});
    GltfMaterials found(path, model);
    for (int i = 0; i < static_cast<int>(model.materials.size()); ++i) {
      const std::string name = gltf_material_name(model, i);
      if (materials.count(name) == 0) materials[name] = found.material(i);
    }
  } catch (const Error&) {  // a library that is none, such as a file that was replaced meanwhile
  }
}

void GltfMaterials::examine(int number) { find_image(number); }

const tinygltf::Image* GltfMaterials::find_image(int material) {
  const tinygltf::TextureInfo& info =
      model_.materials[static_cast<std::size_t>(material)].pbrMetallicRoughness.baseColorTexture;
  if (info.index < 0 || static_cast<std::size_t>(info.index) >= model_.textures.size()) return nullptr;
  const int image = model_.textures[static_cast<std::size_t>(info.index)].source;
  if (image < 0 || static_cast<std::size_t>(image) >= model_.images.size()) return nullptr;
  const bool other_set = info.texCoord != 0;
  const bool moved = info.extensions.count("KHR_texture_transform") > 0;
  other_sets_ = other_sets_ || other_set;
  transforms_ = transforms_ || moved;
  if (other_set || moved) return nullptr;
  images_.insert(image);
  return &model_.images[static_cast<std::size_t>(image)];
}

std::shared_ptr<const std::string> GltfMaterials::bytes_of(const tinygltf::Image& image) {
  if (image.bufferView < 0) {
    return image.image.empty() ? nullptr : std::make_shared<const std::string>(image.image.begin(), image.image.end());
  }
  std::shared_ptr<const std::string>& bytes = in_buffers_[image.bufferView];
  if (bytes != nullptr || static_cast<std::size_t>(image.bufferView) >= model_.bufferViews.size()) return bytes;
  const tinygltf::BufferView& view = model_.bufferViews[static_cast<std::size_t>(image.bufferView)];
  if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model_.buffers.size()) return nullptr;
  const std::vector<unsigned char>& data = model_.buffers[static_cast<std::size_t>(view.buffer)].data;
  if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset) return nullptr;
  // Views may overlap, so that a small file could hold many large images.
  constexpr std::size_t kMostTimes = 4;
  bytes_ += view.byteLength;
  if (bytes_ / kMostTimes > data.size()) return nullptr;
  const auto first = data.begin() + static_cast<std::ptrdiff_t>(view.byteOffset);
  bytes = std::make_shared<const std::string>(first, first + static_cast<std::ptrdiff_t>(view.byteLength));
  return bytes;
}

void GltfMaterials::tell(std::set<std::string>& skipped) const {
  if (other_sets_) skipped.insert("images with texture coordinates of a second set");
  if (transforms_) skipped.insert("images with a texture transform");
  if (images_.size() < model_.images.size()) skipped.insert("images other than base colours");
}

GltfImages::GltfImages(const Materials& materials) {
  std::map<const std::string*, int> in_memory;
  std::map<std::string, int> in_files;
  for (const auto& [name, material] : materials) {
    int& number = material.image != nullptr ? in_memory.emplace(material.image.get(), -1).first->second
                                            : in_files.emplace(material.texture, -1).first->second;
    if (number < 0) {
      const std::shared_ptr<const std::string> bytes = load_image(material);
      if (bytes == nullptr) continue;
      number = static_cast<int>(images_.size());
      images_.push_back({bytes, std::filesystem::path(material.texture).filename().string()});
    }
    textures_[name] = number;
  }
}

std::size_t GltfImages::byte_count() const {
  std::size_t bytes = 0;
  for (const Image& image : images_) bytes += image.bytes->size() + 4;
  return bytes;
}

void GltfImages::add(GlbBlocks& blocks, tinygltf::Model& model) {
  for (const Image& image : images_) {
    tinygltf::Image added;
    added.name = image.name;
    added.mimeType = image_type(*image.bytes);
    added.bufferView = blocks.add_bytes(*image.bytes);
    tinygltf::Texture texture;
    texture.source = static_cast<int>(model.images.size());
    model.images.push_back(std::move(added));
    model.textures.push_back(std::move(texture));
  }
}

int GltfImages::texture(const std::string& name) const {
  const auto found = textures_.find(name);
  return found == textures_.end() ? -1 : found->second;
}

}  // namespace batten::io
