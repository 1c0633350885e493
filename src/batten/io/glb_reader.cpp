/// glTF 2.0 in: the triangles of the scene's nodes as one mesh.
#include <tiny_gltf.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <system_error>

#include "batten/error.h"
#include "batten/io/corner_values.h"
#include "batten/io/faces.h"
#include "batten/io/formats.h"
#include "batten/io/glb_accessor.h"
#include "batten/io/glb_materials.h"
#include "batten/io/glb_model.h"
#include "batten/io/vertex_welder.h"
#include "batten/progress.h"

namespace batten::io {

namespace {

[[noreturn]] void fail(const std::string& name, const std::string& what) {
  throw Error(ErrorCode::BadFile, name + ": " + what);
}

/// The node's own matrix.
Eigen::Matrix4d matrix_of(const tinygltf::Node& node) {
  if (node.matrix.size() == 16) return Eigen::Map<const Eigen::Matrix4d>(node.matrix.data());
  Eigen::Affine3d moved = Eigen::Affine3d::Identity();
  const std::vector<double>& t = node.translation;
  const std::vector<double>& r = node.rotation;
  const std::vector<double>& s = node.scale;
  if (t.size() == 3) moved.translate(Eigen::Vector3d(t[0], t[1], t[2]));
  if (r.size() == 4) moved.rotate(Eigen::Quaterniond(r[3], r[0], r[1], r[2]).normalized());
  if (s.size() == 3) moved.scale(Eigen::Vector3d(s[0], s[1], s[2]));
  return moved.matrix();
}

class GltfReader {
 public:
  explicit GltfReader(const Source& source)
      : source_(source), model_(load_gltf(source)), materials_(source.name, model_) {}

  Mesh read() {
    for (const std::string& extension : model_.extensionsRequired) {
      for (const char* packing : kGltfPackings) {
        if (extension == packing) refuse_packed(source_.name, packing);
      }
    }
    add_nodes();
    std::vector<FaceList> parts;
    parts.push_back(std::move(faces_));
    join_faces(source_.name, parts, mesh_);
    mesh_.points = Eigen::Map<const Points>(points_.data(), static_cast<Eigen::Index>(points_.size() / 3), 3);
    if (mesh_.face_count() == 0) fail(source_.name, "no triangles in it");
    if (!has_alpha_) colors_.drop_last_column();
    for (CornerValues* values : {&uvs_, &normals_, &colors_}) values->move_to(mesh_);
    note_skipped();
    return std::move(mesh_);
  }

 private:
  std::vector<int> roots() const {
    if (!model_.scenes.empty()) {
      const int scene = std::max(model_.defaultScene, 0);
      if (static_cast<std::size_t>(scene) >= model_.scenes.size())
        fail(source_.name, "scene " + std::to_string(scene) + " is not in the file; export it again");
      return model_.scenes[static_cast<std::size_t>(scene)].nodes;
    }
    std::vector<int> all;
    std::set<int> children;
    for (const tinygltf::Node& node : model_.nodes) children.insert(node.children.begin(), node.children.end());
    for (int i = 0; i < static_cast<int>(model_.nodes.size()); ++i) {
      if (children.count(i) == 0) all.push_back(i);
    }
    return all;
  }

  /// Adds the meshes of the scene's nodes, parents first.
  void add_nodes() {
    struct Next {
      int node;
      Eigen::Matrix4d parent;
    };
    std::vector<Next> stack;
    const auto push = [&](const std::vector<int>& nodes, const Eigen::Matrix4d& parent) {
      const auto pushed = static_cast<std::ptrdiff_t>(stack.size());
      for (const int node : nodes) stack.push_back({node, parent});
      std::reverse(stack.begin() + pushed, stack.end());
    };
    std::vector<std::uint8_t> visited(model_.nodes.size(), 0);
    push(roots(), Eigen::Matrix4d::Identity());
    while (!stack.empty()) {
      const Next next = stack.back();
      stack.pop_back();
      const auto index = static_cast<std::size_t>(next.node);
      if (next.node < 0 || index >= model_.nodes.size())
        fail(source_.name, "node " + std::to_string(next.node) + " is not in the file; export it again");
      if (visited[index]++ > 0)
        fail(source_.name, "node " + std::to_string(next.node) + " has two parents; give each copy a node of its own");
      const tinygltf::Node& node = model_.nodes[index];
      const Eigen::Matrix4d matrix = next.parent * matrix_of(node);
      if (node.mesh >= 0) add_mesh(node, matrix);
      if (node.skin >= 0) skipped_.insert("skins");
      push(node.children, matrix);
    }
  }

  void add_mesh(const tinygltf::Node& node, const Eigen::Matrix4d& matrix) {
    if (static_cast<std::size_t>(node.mesh) >= model_.meshes.size())
      fail(source_.name, "mesh " + std::to_string(node.mesh) + " is not in the file; export it again");
    const tinygltf::Mesh& mesh = model_.meshes[static_cast<std::size_t>(node.mesh)];
    const auto first_vertex = static_cast<Index>(points_.size() / 3);
    add_group("o", node.name.empty() ? mesh.name : node.name);
    // Materials and seams split vertices; equal places within one mesh are one vertex again.
    VertexWelder welder(source_.name);
    for (const tinygltf::Primitive& primitive : mesh.primitives) add_primitive(primitive, matrix, first_vertex, welder);
    const Points welded = welder.points();
    require_index_count(source_.name, points_.size() / 3 + static_cast<std::size_t>(welded.rows()), "vertices");
    for (Eigen::Index i = 0; i < welded.rows(); ++i) {
      const Eigen::Vector4d moved = matrix * welded.row(i).transpose().homogeneous();
      if (!moved.allFinite()) fail_at(first_vertex + static_cast<Index>(i));
      points_.insert(points_.end(), moved.data(), moved.data() + 3);
    }
  }

  [[noreturn]] void fail_at(Index vertex) const {
    throw Error(ErrorCode::NotFinite, source_.name + ": vertex " + std::to_string(vertex) +
                                          " has no finite place; export the mesh again without it");
  }

  void add_group(const std::string& keyword, std::string name) {
    std::replace_if(
        name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < 32; }, ' ');
    if (name.empty()) return;
    const auto first_face = static_cast<Index>(faces_.sizes.size());
    const auto same = [&](const Group& group) { return group.keyword == keyword; };
    const auto last = std::find_if(mesh_.groups.rbegin(), mesh_.groups.rend(), same);
    if (last != mesh_.groups.rend() && last->name == name && keyword == "usemtl") return;
    if (last != mesh_.groups.rend() && last->first_face == first_face) mesh_.groups.erase(std::next(last).base());
    mesh_.groups.push_back({keyword, name, first_face});
  }

  /// The primitive's numbers of that meaning; without rows if it has none.
  Values values_of(const tinygltf::Primitive& primitive, const char* meaning, int columns) const {
    const auto found = primitive.attributes.find(meaning);
    if (found == primitive.attributes.end()) return Values(0, columns);
    return read_accessor(source_.name, model_, found->second, columns);
  }

  void add_primitive(const tinygltf::Primitive& primitive, const Eigen::Matrix4d& matrix, Index first_vertex,
                     VertexWelder& welder) {
    report_progress(source_.progress, 0.0);
    if (primitive.extensions.count(kGltfPackings[0]) > 0) refuse_packed(source_.name, kGltfPackings[0]);
    const bool triangles = primitive.mode < 0 || primitive.mode == TINYGLTF_MODE_TRIANGLES ||
                           primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
                           primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN;
    if (!triangles) {
      skipped_.insert("points and lines");
      return;
    }
    if (!primitive.targets.empty()) skipped_.insert("morph targets");
    const Values places = values_of(primitive, "POSITION", 3);
    const std::vector<Index> corners = corners_of(primitive, places.rows());
    const std::vector<Index> vertices = weld(places, corners, first_vertex, welder);
    add_group("usemtl", gltf_material_name(model_, primitive.material));
    add_material(primitive.material, primitive.attributes.count("COLOR_0") > 0);
    const Eigen::Matrix3d linear = matrix.topLeftCorner<3, 3>();
    add_triangles(corners, primitive.mode, linear.determinant() < 0.0, vertices,
                  shown_values(primitive, linear, places.rows()));
  }

  /// The file itself is the library that says how its materials look.
  void add_material(int material, bool colored) {
    if (!materials_.has_look(material, colored)) return;
    materials_.examine(material);
    std::error_code error;
    const std::filesystem::path path = std::filesystem::absolute(source_.name, error);
    if (error || !is_gltf_library(source_.name) || !std::filesystem::is_regular_file(path, error)) {
      skipped_.insert("colours and images of materials");
    } else if (mesh_.material_libraries.empty()) {
      mesh_.material_libraries.push_back(path.string());
    }
  }

  /// The mesh's vertices of those of the primitive that have corners, and -1 for the others. Several primitives may
  /// share one list.
  std::vector<Index> weld(const Values& places, const std::vector<Index>& corners, Index first_vertex,
                          VertexWelder& welder) const {
    constexpr Index kUnused = -1;
    std::vector<Index> vertices(static_cast<std::size_t>(places.rows()), kUnused);
    for (const Index corner : corners) vertices[static_cast<std::size_t>(corner)] = 0;
    for (Eigen::Index i = 0; i < places.rows(); ++i) {
      Index& vertex = vertices[static_cast<std::size_t>(i)];
      if (vertex == kUnused) continue;
      if (!places.row(i).allFinite()) fail_at(static_cast<Index>(i));
      vertex = first_vertex + welder.add(places.row(i).data());
    }
    return vertices;
  }

  /// The primitive's values as a mesh has them, for each of its vertices; without rows where it has none.
  struct Shown {
    Values uvs;
    Values normals;
    Values colors;
  };

  Shown shown_values(const tinygltf::Primitive& primitive, const Eigen::Matrix3d& linear, Eigen::Index count) {
    Shown shown{values_of(primitive, "TEXCOORD_0", 2), values_of(primitive, "NORMAL", 3),
                values_of(primitive, "COLOR_0", 0)};
    for (const Values* values : {&shown.uvs, &shown.normals, &shown.colors}) {
      if (values->rows() > 0 && values->rows() != count)
        fail(source_.name, "the attributes of a mesh differ in length");
    }
    if (shown.uvs.rows() > 0) shown.uvs.col(1) = 1.0 - shown.uvs.col(1).array();  // v points down in glTF
    // The transposed inverse, times the determinant, which only scales.
    Eigen::Matrix3d cofactors;
    cofactors << linear.col(1).cross(linear.col(2)), linear.col(2).cross(linear.col(0)),
        linear.col(0).cross(linear.col(1));
    if (linear.determinant() < 0.0) cofactors = -cofactors;
    for (Eigen::Index i = 0; i < shown.normals.rows(); ++i) {
      const Eigen::Vector3d turned = cofactors * shown.normals.row(i).transpose();
      shown.normals.row(i) = turned.stableNormalized().transpose();
    }
    Values& colors = shown.colors;
    if (colors.rows() == 0) return shown;
    if (colors.cols() != 3 && colors.cols() != 4) fail(source_.name, "a colour has 3 or 4 numbers");
    has_alpha_ = has_alpha_ || colors.cols() == 4;
    Values all = Values::Ones(count, 4);
    all.leftCols(3) = colors.leftCols(3).unaryExpr(&srgb_from_linear);
    if (colors.cols() == 4) all.col(3) = colors.col(3);
    colors = std::move(all);
    return shown;
  }

  /// The vertices of the primitive in the order of its triangles, strip or fan.
  std::vector<Index> corners_of(const tinygltf::Primitive& primitive, Eigen::Index vertex_count) const {
    std::vector<Index> corners;
    if (primitive.indices < 0) {
      for (Eigen::Index i = 0; i < vertex_count; ++i) corners.push_back(static_cast<Index>(i));
      return corners;
    }
    const Values indices = read_accessor(source_.name, model_, primitive.indices, 1);
    for (Eigen::Index i = 0; i < indices.rows(); ++i) {
      if (!(indices(i, 0) >= 0.0 && indices(i, 0) < static_cast<double>(vertex_count))) {
        throw Error(ErrorCode::IndexOutOfRange, source_.name + ": a triangle names vertex " +
                                                    std::to_string(static_cast<std::int64_t>(indices(i, 0))) +
                                                    ", but its mesh has " + std::to_string(vertex_count));
      }
      corners.push_back(static_cast<Index>(indices(i, 0)));
    }
    return corners;
  }

  void add_triangles(const std::vector<Index>& corners, int mode, bool mirrored, const std::vector<Index>& vertices,
                     const Shown& shown) {
    const bool list = mode != TINYGLTF_MODE_TRIANGLE_STRIP && mode != TINYGLTF_MODE_TRIANGLE_FAN;
    for (std::size_t i = 0; i + 2 < corners.size(); i += list ? 3 : 1) {
      std::array<Index, 3> triangle{corners[i], corners[i + 1], corners[i + 2]};
      if (mode == TINYGLTF_MODE_TRIANGLE_FAN) triangle[0] = corners[0];
      if (mode == TINYGLTF_MODE_TRIANGLE_STRIP && i % 2 == 1) std::swap(triangle[0], triangle[1]);
      if (mirrored) std::swap(triangle[1], triangle[2]);
      // Strips are led on by triangles without area.
      const bool flat = triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0];
      if (!list && flat) continue;
      for (const Index corner : triangle) add_corner(corner, vertices[static_cast<std::size_t>(corner)], shown);
      faces_.sizes.push_back(3);
    }
  }

  void add_corner(Index corner, Index vertex, const Shown& shown) {
    const auto row = [&](const Values& values) { return values.rows() > 0 ? values.row(corner).data() : nullptr; };
    faces_.vertices.push_back(vertex);
    uvs_.add(vertex, row(shown.uvs));
    normals_.add(vertex, row(shown.normals));
    colors_.add(vertex, row(shown.colors));
  }

  void note_skipped() {
    if (!model_.animations.empty()) skipped_.insert("animations");
    materials_.tell(skipped_);
    std::string names;
    for (const std::string& name : skipped_) names += (names.empty() ? "" : ", ") + name;
    if (!names.empty()) note(source_, "parts that are skipped: " + names);
  }

  const Source& source_;
  tinygltf::Model model_;
  GltfMaterials materials_;
  Buffer<double> points_;
  FaceList faces_;
  CornerValues uvs_{"uv", 2};
  CornerValues normals_{"normal", 3};
  CornerValues colors_{"color", 4};
  bool has_alpha_ = false;
  std::set<std::string> skipped_;
  Mesh mesh_;
};

}  // namespace

Mesh read_gltf(const Source& source) { return GltfReader(source).read(); }

}  // namespace batten::io
