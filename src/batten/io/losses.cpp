#include "batten/io/losses.h"

#include <algorithm>
#include <cstdint>
#include <optional>

#include "batten/error.h"
#include "batten/io/formats.h"
#include "batten/io/materials.h"
#include "batten/io/ply_faces.h"
#include "batten/output.h"

namespace batten {

namespace {

enum class Kept { Nowhere, Vertices, Anywhere };
enum class KeptGroups { None, Materials, All };

/// What a format has a place for.
struct Place {
  const char* format;
  bool faces;
  bool polygons;  ///< and vertices without a face
  bool rules;     ///< boundary rule, crease method, triangle and face-varying rules, creases, corners, holes
  bool scheme;
  Kept normals;
  Kept uvs;
  Kept colors;
  Kept others;
  KeptGroups groups;
};

constexpr Place kPlaces[] = {
    {"obj", true, true, true, false, Kept::Anywhere, Kept::Anywhere, Kept::Vertices, Kept::Nowhere, KeptGroups::All},
    {"ply", true, true, false, false, Kept::Vertices, Kept::Anywhere, Kept::Vertices, Kept::Vertices, KeptGroups::None},
    {"off", true, true, false, false, Kept::Nowhere, Kept::Nowhere, Kept::Nowhere, Kept::Nowhere, KeptGroups::None},
    {"stl", true, false, false, false, Kept::Nowhere, Kept::Nowhere, Kept::Nowhere, Kept::Nowhere, KeptGroups::None},
    {"xyz", false, true, false, false, Kept::Vertices, Kept::Nowhere, Kept::Nowhere, Kept::Nowhere, KeptGroups::None},
    {"glb", true, false, false, false, Kept::Anywhere, Kept::Anywhere, Kept::Anywhere, Kept::Nowhere,
     KeptGroups::Materials},
    {"usda", true, true, true, true, Kept::Anywhere, Kept::Anywhere, Kept::Anywhere, Kept::Anywhere,
     KeptGroups::Materials},
    {"vtk", true, true, false, false, Kept::Nowhere, Kept::Nowhere, Kept::Nowhere, Kept::Nowhere, KeptGroups::None},
    {"fsb", true, false, false, false, Kept::Nowhere, Kept::Nowhere, Kept::Nowhere, Kept::Nowhere, KeptGroups::None},
    {"gii", true, false, false, false, Kept::Nowhere, Kept::Nowhere, Kept::Nowhere, Kept::Nowhere, KeptGroups::None},
};

class Losses {
 public:
  Losses(const std::string& path, const Place& place, const Mesh& mesh) : path_(path), place_(place), mesh_(mesh) {}

  std::vector<std::string> find(bool binary) {
    shape(binary);
    surface();
    for (const Attribute& attribute : mesh_.attributes) values(attribute);
    groups();
    materials();
    return std::move(lost_);
  }

 private:
  void add(bool lost, const std::string& what) {
    if (lost && std::find(lost_.begin(), lost_.end(), what) == lost_.end()) lost_.push_back(what);
  }
  bool is(const char* format) const { return std::string(place_.format) == format; }

  void shape(bool binary) {
    const Index faces = mesh_.face_count();
    add(!place_.faces && faces > 0, "faces");
    if (place_.faces && !place_.polygons && faces > 0) {
      add(!all_triangles(mesh_), "polygons (cut into triangles)");
      add(!keeps_vertices() && has_loose_vertices(), "vertices without a face");
    }
    add(((is("stl") && binary) || is("gii") || (is("fsb") && binary)) && !fits_floats(), "digits of the coordinates");
  }

  /// Triangles by the numbers of vertices, which are all there.
  bool keeps_vertices() const { return is("fsb") || is("gii"); }

  bool has_loose_vertices() const {
    std::vector<std::uint8_t> used(static_cast<std::size_t>(mesh_.vertex_count()), 0);
    for (const Index vertex : mesh_.face_vertices) {
      if (vertex >= 0 && vertex < mesh_.vertex_count()) used[vertex] = 1;
    }
    return std::find(used.begin(), used.end(), 0) != used.end();
  }

  /// A float has 24 bits, and one that is rounded is wrong by half of the last.
  bool fits_floats() const {
    constexpr double kHalfBit = 1.0 / (1 << 24);
    constexpr double kDigits = 1e-6;
    const double size = bounding_diagonal(mesh_.points);
    return mesh_.vertex_count() == 0 || mesh_.points.cwiseAbs().maxCoeff() * kHalfBit <= kDigits * size;
  }

  /// A USD mesh is a surface or polygons; the latter have no tags, but then there are none to lose, except those of a
  /// Butterfly surface.
  void surface() {
    const bool butterfly = mesh_.scheme && is_interpolating(*mesh_.scheme);
    const SchemeKind by_faces = all_triangles(mesh_) ? SchemeKind::Loop : SchemeKind::CatmullClark;
    add(mesh_.scheme && (place_.scheme ? butterfly : *mesh_.scheme != by_faces), "scheme");
    const bool kept = place_.rules && !(is("usda") && butterfly);
    add(!kept && mesh_.boundary.value_or(BoundaryRule::EdgeOnly) != BoundaryRule::EdgeOnly, "boundary rule");
    add(!kept && !mesh_.creases.empty(), "creases");
    add(!kept && !mesh_.corners.empty(), "corners");
    add(!kept && !mesh_.holes.empty(), "holes");
    // USD has no Chaikin creases; it is written only where they make no difference.
    add(!kept && mesh_.crease_method == CreaseMethod::Chaikin, "crease method");
    add(!kept && mesh_.triangle_rule == TriangleRule::Smooth, "triangle rule");
    add(!kept && mesh_.face_varying.value_or(FaceVaryingRule::All) != FaceVaryingRule::All, "face-varying rule");
  }

  void values(const Attribute& attribute) {
    const bool is_normal = attribute.name == "normal";
    const bool is_uv = attribute.name == "uv";
    const bool is_color = attribute.name == "color";
    Kept kept = is_normal ? place_.normals : is_uv ? place_.uvs : is_color ? place_.colors : place_.others;
    if (is("usda") && is_normal && !io::is_usda_polygonal(mesh_)) kept = Kept::Nowhere;
    if (is("glb") && io::is_glb_own(attribute)) return;
    if (kept == Kept::Anywhere || (kept == Kept::Vertices && !attribute.per_corner())) return;
    const std::string what = is_normal  ? "normals"
                             : is_uv    ? "texture coordinates"
                             : is_color ? "colours"
                                        : "attribute '" + attribute.name + "'";
    add(true, what + (kept == Kept::Vertices ? " at corners" : ""));
  }

  void groups() {
    for (const Group& group : mesh_.groups) {
      const bool material = group.keyword == "usemtl";
      const bool kept = place_.groups == KeptGroups::All || (material && place_.groups == KeptGroups::Materials) ||
                        (material && keeps_textures());
      if (kept) continue;
      const bool smoothing = group.keyword == "s";
      if (smoothing && (group.name == "off" || group.name == "0" || group.name.empty())) continue;
      add(true, material ? "materials" : smoothing ? "smoothing groups" : "groups");
    }
  }

  /// PLY has images, but neither names nor colours of materials.
  bool keeps_textures() {
    if (is("ply") && !textures_complete_) textures_complete_ = io::ply_textures(path_, mesh_).complete;
    return textures_complete_.value_or(false);
  }

  void materials() {
    const std::vector<std::string>& libraries = mesh_.material_libraries;
    if (is("obj")) return gltf_materials();
    if (place_.groups == KeptGroups::None) return add(!libraries.empty(), "materials");
    if (!is("glb")) return add(!libraries.empty(), "material library");
    const io::Materials found = io::find_materials(path_, mesh_);
    add(!libraries.empty(), found.empty() ? "material library" : "materials but for colours and images");
    add(lack_images(found), "images of materials");
  }

  /// What OBJ's material files have no place for; what stands in one stays there.
  void gltf_materials() {
    const std::vector<std::string>& libraries = mesh_.material_libraries;
    if (std::none_of(libraries.begin(), libraries.end(), io::is_gltf_library)) return;
    if (io::is_special_target(path_)) return add(true, "colours and images of materials");
    const io::Materials found = io::find_materials(path_, mesh_);
    add(true, found.empty() ? "material library" : "materials but for colours and images");
    add(lack_images(found), "images of materials");
  }

  static bool lacks_image(const io::Material& material) {
    return (material.image != nullptr || !material.texture.empty()) && !io::has_image(material);
  }
  static bool lack_images(const io::Materials& materials) {
    return std::any_of(materials.begin(), materials.end(), [](const auto& named) { return lacks_image(named.second); });
  }

  const std::string& path_;
  const Place& place_;
  const Mesh& mesh_;
  std::optional<bool> textures_complete_;
  std::vector<std::string> lost_;
};

}  // namespace

std::vector<std::string> find_losses(const std::string& path, const Mesh& mesh, const WriteOptions& options) {
  const std::string format = file_format(path, options.format);
  const Place* const place =
      std::find_if(std::begin(kPlaces), std::end(kPlaces), [&](const Place& p) { return format == p.format; });
  if (place == std::end(kPlaces)) {
    throw Error(ErrorCode::UnknownFormat, path + ": " + format + " is only read; write glb instead");
  }
  return Losses(path, *place, mesh).find(options.binary);
}

}  // namespace batten
