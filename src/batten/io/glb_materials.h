/// \file Base colours and images of materials in glTF.
#pragma once
#include <tiny_gltf.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "batten/io/glb_blocks.h"
#include "batten/io/materials.h"

namespace batten::io {

/// Colours of meshes and pictures are sRGB; those of glTF are linear. Values are clamped to [0, 1].
double linear_from_srgb(double value);
double srgb_from_linear(double value);

/// The name that the faces of a material have as a group; none for a number that is not in the file.
std::string gltf_material_name(const tinygltf::Model& model, int material);

/// The materials of a model as a mesh may have them: base colours, and images that the first set of texture coordinates
/// places as it stands.
class GltfMaterials {
 public:
  /// Both must outlive this object. `name` is the file's, in whose folder images lie.
  GltfMaterials(const std::string& name, const tinygltf::Model& model) : name_(name), model_(model) {}

  /// Of materials from 0 to the model's number. Images of more than four times the buffers together are left out.
  Material material(int number);
  /// Notes what of a material is kept, for tell().
  void examine(int number);
  /// True if the material looks like something else than what a writer gives to faces without one: grey, or white where
  /// there are colours.
  bool has_look(int number, bool colored) const;
  /// Adds what is not kept of the materials asked for, and other images.
  void tell(std::set<std::string>& skipped) const;

 private:
  /// The image of a material, or null.
  const tinygltf::Image* find_image(int material);
  std::shared_ptr<const std::string> bytes_of(const tinygltf::Image& image);

  const std::string& name_;
  const tinygltf::Model& model_;
  std::set<int> images_;
  std::map<int, std::shared_ptr<const std::string>> in_buffers_;  ///< by buffer view
  std::size_t bytes_ = 0;                                         ///< of the images in buffers
  bool other_sets_ = false;
  bool transforms_ = false;
};

/// Adds the materials of a glTF file by name; none if it cannot be read.
void read_gltf_materials(const std::string& path, Materials& materials);

/// Images of materials, each loaded once, for a model that is written.
class GltfImages {
 public:
  explicit GltfImages(const Materials& materials);

  std::size_t byte_count() const;
  /// Adds the images to the model.
  void add(GlbBlocks& blocks, tinygltf::Model& model);
  /// The number of the texture of the material of that name in the model, or -1.
  int texture(const std::string& name) const;

 private:
  struct Image {
    std::shared_ptr<const std::string> bytes;
    std::string name;
  };
  std::vector<Image> images_;
  std::map<std::string, int> textures_;
};

}  // namespace batten::io
