#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ostream>
#include <streambuf>

#include "batten/error.h"
#include "batten/io/drawn_normals.h"
#include "batten/io/face_sets.h"
#include "batten/io/float_frame.h"
#include "batten/io/formats.h"
#include "batten/io/glb_blocks.h"
#include "batten/io/glb_materials.h"
#include "batten/io/merged_corners.h"
#include "batten/mesh/triangulate.h"

namespace batten::io {

namespace {

/// A stream for tinygltf that passes its bytes on to the file. The stream carries the file's errors back.
class FileStream : public std::streambuf {
 public:
  explicit FileStream(OutputFile& file) : file_(file) {}

 protected:
  std::streamsize xsputn(const char* bytes, std::streamsize count) override {
    file_.write(bytes, static_cast<std::size_t>(count));
    return count;
  }
  int_type overflow(int_type c) override {
    const char byte = traits_type::to_char_type(c);
    file_.write(&byte, 1);
    return traits_type::not_eof(c);
  }

 private:
  OutputFile& file_;
};

/// The model that tinygltf writes: one mesh with a primitive for each material, all with the same vertices.
class SurfaceModel {
 public:
  SurfaceModel(const std::string& name, const Mesh& mesh, UpAxis up, const MorphTargets* morph)
      : mesh_(mesh),
        turned_(to_y_up(up)),
        morph_(morph),
        hidden_(hidden_faces(mesh)),
        frame_(float_frame(name, mesh.points)),
        uv_(corner_list(mesh, "uv")),
        color_(corner_list(mesh, "color")),
        normals_(name, mesh, hidden_) {
    require_finite(name, uv_);
    require_finite(name, color_);
    corners_ = merge_corners(mesh, {uv_, corner_list(mesh, "normal"), color_}, hidden_);
    if (vertex_count() == 0) {
      throw Error(ErrorCode::BadShape, name + ": GLB holds triangles only, and the mesh has no face; write xyz or ply");
    }
    const std::vector<FaceSet> sets = faces_by_material(mesh);
    materials_ = find_materials(name, mesh);
    GltfImages images(materials_);
    GlbBlocks blocks(name, model_, byte_count() + images.byte_count() + 4 * sets.size());
    const std::map<std::string, int> attributes = add_attributes(blocks);
    const std::vector<std::map<std::string, int>> targets = add_targets(blocks);
    model_.meshes.emplace_back();
    model_.meshes[0].name = "surface";
    for (const FaceSet& set : sets) {
      const Buffer<Index> triangles = first_triangles(set);
      if (triangles.back() == 0) continue;
      tinygltf::Primitive primitive;
      primitive.mode = TINYGLTF_MODE_TRIANGLES;
      primitive.attributes = attributes;
      primitive.targets = targets;
      primitive.material = add_material(set, images);
      const auto fill = [&](const auto& put) { put_triangles(set, triangles, put); };
      const std::size_t count = 3 * static_cast<std::size_t>(triangles.back());
      primitive.indices = short_indices() ? blocks.add_indices<std::uint16_t>(count, fill)
                                          : blocks.add_indices<std::uint32_t>(count, fill);
      model_.meshes[0].primitives.push_back(std::move(primitive));
    }
    images.add(blocks, model_);
    add_scene();
    if (morph_ != nullptr) add_animation(blocks);
  }

  const tinygltf::Model& model() const { return model_; }

 private:
  /// glTF has y up. Without a turn, zeros keep their signs.
  Eigen::RowVector3d turned(const Eigen::RowVector3d& row) const {
    return turned_.isIdentity(0.0) ? row : Eigen::RowVector3d((turned_ * row.transpose()).transpose());
  }
  std::ptrdiff_t vertex_count() const { return static_cast<std::ptrdiff_t>(corners_.corner_of_vertex.size()); }
  /// The index 65535 is reserved: it would restart the primitive.
  bool short_indices() const { return vertex_count() <= 65535; }

  std::size_t byte_count() const {
    const std::ptrdiff_t floats = 6 + (uv_.attribute != nullptr ? 2 : 0) +
                                  (color_.attribute != nullptr ? color_.attribute->values.cols() : 0) + own_columns();
    const std::size_t triangles = mesh_.face_vertices.size() - 2 * static_cast<std::size_t>(mesh_.face_count());
    std::size_t moving = 0;
    if (morph_ != nullptr) {
      moving = 3 * (morph_->displacements.size() + morph_->normals.size()) * static_cast<std::size_t>(vertex_count()) +
               morph_->times.size() + static_cast<std::size_t>(morph_->weights.size());
    }
    return (static_cast<std::size_t>(floats * vertex_count()) + moving) * sizeof(float) +
           triangles * 3 * (short_indices() ? sizeof(std::uint16_t) : sizeof(std::uint32_t));
  }

  std::ptrdiff_t own_columns() const {
    std::ptrdiff_t columns = 0;
    for (const Attribute& attribute : mesh_.attributes) {
      if (is_glb_own(attribute)) columns += attribute.values.cols();
    }
    return columns;
  }

  template <int K>
  int add_own(GlbBlocks& blocks, const Attribute& attribute) const {
    return blocks.add_floats<K>(vertex_count(), [&](std::ptrdiff_t i) {
      const Index vertex = mesh_.face_vertices[corners_.corner_of_vertex[i]];
      return Eigen::Matrix<double, 1, K>(attribute.values.row(vertex));
    });
  }

  /// Numbers that glTF has no name for, under names of their own.
  void add_own(GlbBlocks& blocks, std::map<std::string, int>& attributes) const {
    for (const Attribute& attribute : mesh_.attributes) {
      if (!is_glb_own(attribute)) continue;
      std::string name = glb_own_name(attribute.name);
      while (attributes.count(name) > 0) name += '_';  // "a b" and "a_b" would have one
      const Eigen::Index columns = attribute.values.cols();
      attributes[name] = columns == 1   ? add_own<1>(blocks, attribute)
                         : columns == 2 ? add_own<2>(blocks, attribute)
                         : columns == 3 ? add_own<3>(blocks, attribute)
                                        : add_own<4>(blocks, attribute);
    }
  }

  /// `otherwise` is the value at corners without a row.
  template <int K>
  Eigen::Matrix<double, 1, K> value(const CornerList& list, Index corner, double otherwise) const {
    const Index row = list.row(mesh_, corner);
    if (row < 0) return Eigen::Matrix<double, 1, K>::Constant(otherwise);
    return list.attribute->values.row(row);
  }

  template <int K>
  Eigen::Matrix<double, 1, K> linear_color(Index corner) const {
    Eigen::Matrix<double, 1, K> color = value<K>(color_, corner, 1.0);
    for (int k = 0; k < 3; ++k) color[k] = linear_from_srgb(color[k]);
    if (K == 4) color[K - 1] = std::clamp(color[K - 1], 0.0, 1.0);
    return color;
  }

  std::map<std::string, int> add_attributes(GlbBlocks& blocks) const {
    std::map<std::string, int> attributes;
    const auto corner = [&](std::ptrdiff_t vertex) { return corners_.corner_of_vertex[vertex]; };
    attributes["POSITION"] = blocks.add_floats<3>(vertex_count(), [&](std::ptrdiff_t i) {
      return turned(mesh_.points.row(mesh_.face_vertices[corner(i)]) - frame_.origin);
    });
    blocks.add_bounds(attributes["POSITION"]);
    attributes["NORMAL"] =
        blocks.add_floats<3>(vertex_count(), [&](std::ptrdiff_t i) { return turned(normals_.at(corner(i))); });
    if (uv_.attribute != nullptr) {
      attributes["TEXCOORD_0"] = blocks.add_floats<2>(vertex_count(), [&](std::ptrdiff_t i) {
        const Eigen::RowVector2d uv = value<2>(uv_, corner(i), 0.0);
        return Eigen::RowVector2d(uv[0], 1.0 - uv[1]);  // v points down in glTF
      });
    }
    if (color_.attribute != nullptr && color_.attribute->values.cols() == 4) {
      attributes["COLOR_0"] =
          blocks.add_floats<4>(vertex_count(), [&](std::ptrdiff_t i) { return linear_color<4>(corner(i)); });
    } else if (color_.attribute != nullptr) {
      attributes["COLOR_0"] =
          blocks.add_floats<3>(vertex_count(), [&](std::ptrdiff_t i) { return linear_color<3>(corner(i)); });
    }
    add_own(blocks, attributes);
    return attributes;
  }

  std::vector<std::map<std::string, int>> add_targets(GlbBlocks& blocks) const {
    std::vector<std::map<std::string, int>> targets;
    if (morph_ == nullptr) return targets;
    for (std::size_t i = 0; i < morph_->displacements.size(); ++i) {
      targets.emplace_back();
      const Points& moved = morph_->displacements[i];
      targets[i]["POSITION"] = blocks.add_floats<3>(vertex_count(), [&](std::ptrdiff_t v) {
        return turned(moved.row(mesh_.face_vertices[corners_.corner_of_vertex[v]]));
      });
      blocks.add_bounds(targets[i]["POSITION"]);
      if (morph_->normals.empty()) continue;
      const Values& rotated = morph_->normals[i];
      const bool at_vertices = rotated.rows() == mesh_.vertex_count();
      targets[i]["NORMAL"] = blocks.add_floats<3>(vertex_count(), [&](std::ptrdiff_t v) {
        const Index corner = corners_.corner_of_vertex[v];
        return turned(rotated.row(at_vertices ? mesh_.face_vertices[corner] : corner));
      });
    }
    return targets;
  }

  /// Adds the weights at the times; the targets of each time are consecutive.
  void add_animation(GlbBlocks& blocks) {
    const std::vector<double>& times = morph_->times;
    const Values& weights = morph_->weights;
    tinygltf::Animation animation;
    animation.name = "morph";
    animation.samplers.emplace_back();
    animation.samplers[0].interpolation = "LINEAR";
    animation.samplers[0].input = blocks.add_numbers(times.data(), static_cast<std::ptrdiff_t>(times.size()));
    blocks.add_bounds(animation.samplers[0].input, 1);
    animation.samplers[0].output = blocks.add_numbers(weights.data(), weights.size());
    animation.channels.emplace_back();
    animation.channels[0].sampler = 0;
    animation.channels[0].target_node = 0;
    animation.channels[0].target_path = "weights";
    model_.animations.push_back(animation);
    const Eigen::RowVectorXd first = weights.row(0);
    model_.meshes[0].weights.assign(first.begin(), first.end());
  }

  int add_material(const FaceSet& set, const GltfImages& images) {
    tinygltf::Material material;
    material.name = set.name.empty() ? "surface" : set.name;
    material.doubleSided = true;
    tinygltf::PbrMetallicRoughness& look = material.pbrMetallicRoughness;
    look.metallicFactor = 0.0;
    look.roughnessFactor = 0.5;
    // The base colour is multiplied by the colours at the vertices.
    const double grey = color_.attribute != nullptr ? 1.0 : 0.8;
    look.baseColorFactor = {grey, grey, grey, 1.0};
    bool translucent = color_.attribute != nullptr && color_.attribute->values.cols() == 4 &&
                       color_.attribute->values.col(3).minCoeff() < 1.0;
    if (const auto known = materials_.find(set.name); known != materials_.end()) {
      const std::array<double, 4>& color = known->second.color;
      for (std::size_t k = 0; k < 3; ++k) look.baseColorFactor[k] = linear_from_srgb(color[k]);
      look.baseColorFactor[3] = std::clamp(color[3], 0.0, 1.0);
      if (uv_.attribute != nullptr) look.baseColorTexture.index = images.texture(set.name);
      translucent = translucent || color[3] < 1.0;
    }
    if (translucent) material.alphaMode = "BLEND";
    model_.materials.push_back(material);
    return static_cast<int>(model_.materials.size()) - 1;
  }

  /// The number of triangles before each face of a set, and the total at the end.
  Buffer<Index> first_triangles(const FaceSet& set) const {
    Buffer<Index> first{0};
    for (const auto& range : set.ranges) {
      for (Index face = range.first; face < range.second; ++face) {
        first.push_back(first.back() + (hidden_[face] != 0 ? 0 : mesh_.face_size(face) - 2));
      }
    }
    return first;
  }

  template <typename Put>
  void put_triangles(const FaceSet& set, const Buffer<Index>& first_triangle, const Put& put) const {
    const Index* first = first_triangle.data();
    for (const auto& range : set.ranges) {
      parallel_for(range.second - range.first, [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
        std::vector<std::array<Index, 3>> triangles;
        for (std::ptrdiff_t i = begin; i < end; ++i) {
          const auto face = static_cast<Index>(range.first + i);
          if (hidden_[face] != 0) continue;
          triangles.clear();
          triangulate_face(mesh_, face, triangles);
          std::ptrdiff_t place = std::ptrdiff_t{3} * first[i];
          for (const std::array<Index, 3>& triangle : triangles) {
            for (const Index k : triangle) put(place++, corners_.vertex_of_corner[mesh_.face_offsets[face] + k]);
          }
        }
      });
      first += range.second - range.first;
    }
  }

  void add_scene() {
    tinygltf::Node node;
    node.name = "surface";
    node.mesh = 0;
    const Eigen::RowVector3d origin = turned(frame_.origin);
    if (!origin.isZero(0.0)) node.translation = {origin[0], origin[1], origin[2]};
    model_.nodes.push_back(node);
    model_.scenes.emplace_back();
    model_.scenes[0].nodes = {0};
    model_.defaultScene = 0;
    model_.asset.version = "2.0";
    model_.asset.generator = "Batten";
  }

  const Mesh& mesh_;
  const Eigen::Matrix3d turned_;
  const MorphTargets* morph_;  ///< may be null
  Buffer<std::uint8_t> hidden_;
  FloatFrame frame_;
  CornerList uv_;
  CornerList color_;
  DrawnNormals normals_;
  MergedCorners corners_;
  Materials materials_;
  tinygltf::Model model_;
};

}  // namespace

void write_glb(OutputFile& file, const Mesh& mesh, UpAxis up, const MorphTargets* targets) {
  const SurfaceModel surface(file.name(), mesh, up, targets);
  FileStream bytes(file);
  std::ostream stream(&bytes);
  stream.exceptions(std::ios::badbit);
  tinygltf::TinyGLTF().WriteGltfSceneToStream(&surface.model(), stream, false, true);
}

}  // namespace batten::io
