#include "batten/io/obj_library.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <system_error>

#include "batten/io/file_paths.h"
#include "batten/io/text_output.h"
#include "batten/output.h"

namespace batten::io {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFirstLine = "# Materials, written by Batten\n";

bool is_letter_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         static_cast<unsigned char>(c) > 127;
}

/// A name that every program reads in a line of a material file: no blanks, slashes or options.
std::string file_stem(const std::string& image) {
  constexpr std::size_t kLongest = 100;
  std::string stem = fs::path(image).stem().string().substr(0, kLongest);
  for (std::size_t i = 0; i < stem.size(); ++i) {
    const bool inner = i > 0 && (stem[i] == '-' || stem[i] == '.');
    if (!is_letter_or_digit(stem[i]) && !inner) stem[i] = '_';
  }
  return stem.empty() ? "image" : stem;
}

/// True if a file may be written under this path: nothing is there, or the same, or an older file of ours.
bool is_free(const std::string& path, const std::string& bytes) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) return true;
  const std::optional<std::string> present = named_file(path, std::max(bytes.size() + 1, kFirstLine.size()));
  if (!present) return false;
  const bool both_ours =
      bytes.compare(0, kFirstLine.size(), kFirstLine) == 0 && present->compare(0, kFirstLine.size(), kFirstLine) == 0;
  return both_ours || *present == bytes;
}

/// Without the last digits, which the way from linear colours to sRGB has spoilt: 0.5 and not 0.4999999999999999.
double rounded(double value) {
  constexpr double kUnits = 1e12;
  return std::round(value * kUnits) / kUnits;
}

void write_beside(const std::string& path, std::string_view bytes) {
  write_atomically(path, [&](const std::string& target) {
    OutputFile file(target, path);
    file.write(bytes);
    file.close();
  });
}

}  // namespace

ObjLibrary::ObjLibrary(const std::string& path, const Mesh& mesh) : path_(path) {
  Mesh described;  // the same materials, as far as glTF files tell of them
  for (const std::string& library : mesh.material_libraries) {
    (is_gltf_library(library) ? described.material_libraries : libraries_).push_back(library);
  }
  if (described.material_libraries.empty() || is_special_target(path)) return;
  described.groups = mesh.groups;
  taken_.insert(libraries_.begin(), libraries_.end());
  taken_.insert(fs::path(path).filename().string());
  text_ = kFirstLine;
  for (const auto& [name, material] : find_materials(path, described)) add_material(name, material);
  if (text_.size() == kFirstLine.size()) return;
  std::string stem = fs::path(path).stem().string();
  std::replace_if(
      stem.begin(), stem.end(), [](char c) { return static_cast<unsigned char>(c) < 32; }, '_');
  name_ = choose_name(stem, ".mtl", text_);
  const auto first = std::find_if(mesh.material_libraries.begin(), mesh.material_libraries.end(), is_gltf_library);
  libraries_.insert(libraries_.begin() + (first - mesh.material_libraries.begin()), name_);
}

void ObjLibrary::add_material(const std::string& name, const Material& material) {
  TextBuffer text;
  text.put("\nnewmtl ").put(std::string_view(name)).put("\nKd");
  for (std::size_t k = 0; k < 3; ++k) text.put(' ').put(rounded(material.color[k]));
  text.put("\nd ").put(material.color[3]).put('\n');
  text_ += text.text();
  if (!has_image(material)) return;
  std::string file = name_in(path_, material.texture);
  if (material.image != nullptr) {
    const auto known = std::find_if(images_.begin(), images_.end(),
                                    [&](const auto& image) { return *image.second == *material.image; });
    const std::string extension = image_type(*material.image) == "image/png" ? ".png" : ".jpg";
    file = known != images_.end() ? known->first : choose_name(file_stem(material.texture), extension, *material.image);
    images_[file] = material.image;
  }
  text_ += "map_Kd " + file + "\n";
}

std::string ObjLibrary::choose_name(const std::string& stem, const std::string& extension, const std::string& bytes) {
  std::string name = stem + extension;
  for (int number = 2; taken_.count(name) > 0 || !is_free(path_named_in(path_, name), bytes); ++number) {
    name = stem;
    name.append("-").append(std::to_string(number)).append(extension);
  }
  taken_.insert(name);
  return name;
}

void ObjLibrary::write() const {
  if (name_.empty()) return;
  std::vector<std::string> created;
  const auto write = [&](const std::string& name, std::string_view bytes, bool replace) {
    const std::string path = path_named_in(path_, name);
    std::error_code error;
    const bool exists = fs::exists(path, error);
    if (exists && !replace) return;
    write_beside(path, bytes);
    if (!exists) created.push_back(path);
  };
  try {
    for (const auto& [name, bytes] : images_) write(name, *bytes, false);
    write(name_, text_, true);
  } catch (...) {
    std::error_code error;
    for (const std::string& path : created) fs::remove(path, error);
    throw;
  }
}

}  // namespace batten::io
