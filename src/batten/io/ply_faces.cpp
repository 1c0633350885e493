#include "batten/io/ply_faces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "batten/io/corner_values.h"
#include "batten/io/face_sets.h"
#include "batten/io/file_paths.h"
#include "batten/io/materials.h"

namespace batten::io {

namespace {

constexpr const char* kNoImage = "untextured";

/// Appends the values of a part whose first face has this number in the mesh.
void append(const PlyUvs& part, std::size_t first_face, PlyUvs& all) {
  if (!part.fits.empty()) {
    all.fits.resize(first_face, 0);
    all.fits.insert(all.fits.end(), part.fits.begin(), part.fits.end());
  }
  all.values.insert(all.values.end(), part.values.begin(), part.values.end());
  all.unfit += part.unfit;
}

/// True if the exact values are those that other programs read, to the precision of these.
bool agree(const PlyUvs& given, const PlyUvs& exact) {
  if (given.fits != exact.fits || given.values.size() != exact.values.size()) return false;
  const auto same = [](double a, double b) { return static_cast<float>(a) == static_cast<float>(b) || std::isnan(b); };
  return std::equal(given.values.begin(), given.values.end(), exact.values.begin(), same);
}

}  // namespace

void PlyUvs::end_row(std::size_t faces, Index size) {
  const bool fit = row.size() == 2 * static_cast<std::size_t>(size);
  fits.resize(faces, 0);
  fits.push_back(fit ? 1 : 0);
  if (fit) values.insert(values.end(), row.begin(), row.end());
  if (!fit && !row.empty()) ++unfit;
  row.clear();
}

void PlyFaces::end_row(bool has_uvs, bool has_exact_uvs, bool has_texture, double texture) {
  const std::size_t before = list.sizes.size() - 1;
  if (has_uvs) uvs.end_row(before, list.sizes.back());
  if (has_exact_uvs) exact_uvs.end_row(before, list.sizes.back());
  if (!has_texture) return;
  textures.resize(before, kNoTexture);
  const bool known = texture >= 0.0 && texture < static_cast<double>(std::numeric_limits<Index>::max());
  textures.push_back(known ? static_cast<Index>(texture) : kNoTexture);
}

void PlyFaceValues::join(const std::string& name, std::vector<PlyFaces>& parts, Mesh& mesh) {
  std::vector<FaceList> lists;
  auto first_face = static_cast<std::size_t>(mesh.face_count());
  for (PlyFaces& part : parts) {
    append(part.uvs, first_face, uvs_);
    append(part.exact_uvs, first_face, exact_uvs_);
    if (!part.textures.empty()) {
      textures_.resize(first_face, PlyFaces::kNoTexture);
      textures_.insert(textures_.end(), part.textures.begin(), part.textures.end());
    }
    first_face += part.list.sizes.size();
    lists.push_back(std::move(part.list));
  }
  parts.clear();
  join_faces(name, lists, mesh);
}

void PlyFaceValues::move_to(const Source& source, const PlyHeader& header, Mesh& mesh) {
  move_uvs(source, mesh);
  move_textures(source, header.texture_files, mesh);
}

void PlyFaceValues::move_uvs(const Source& source, Mesh& mesh) {
  if (uvs_.unfit > 0) {
    note(source, "texture coordinates are skipped where a face has not two numbers for each corner: faces: " +
                     std::to_string(uvs_.unfit));
  }
  if (uvs_.values.empty()) return;
  const auto at_vertices = [](const Attribute& attribute) { return attribute.name == "uv"; };
  const auto other = std::find_if(mesh.attributes.begin(), mesh.attributes.end(), at_vertices);
  if (other != mesh.attributes.end()) {
    note(source, "texture coordinates of the vertices are skipped: the faces have their own");
    mesh.attributes.erase(other);
  }
  const Buffer<double>& values = agree(uvs_, exact_uvs_) ? exact_uvs_.values : uvs_.values;
  CornerValues corners("uv", 2);
  const double* next = values.data();
  for (Index face = 0; face < mesh.face_count(); ++face) {
    const bool given = static_cast<std::size_t>(face) < uvs_.fits.size() && uvs_.fits[face] != 0;
    for (Index corner = mesh.face_offsets[face]; corner < mesh.face_offsets[face + 1]; ++corner) {
      corners.add(mesh.face_vertices[corner], given ? next : nullptr);
      if (given) next += 2;
    }
  }
  corners.move_to(mesh);
}

void PlyFaceValues::move_textures(const Source& source, const std::vector<std::string>& images, Mesh& mesh) const {
  if (mesh.face_count() == 0 || images.empty()) return;
  if (textures_.empty()) {
    if (images.size() > 1) note(source, "images but the first are skipped: no face names them");
    mesh.groups.push_back({"usemtl", images[0], 0});
    return;
  }
  const auto count = static_cast<Index>(images.size());
  const auto number_of = [&](Index face) {
    const bool given = static_cast<std::size_t>(face) < textures_.size() && textures_[face] < count;
    return given ? textures_[face] : PlyFaces::kNoTexture;
  };
  const auto name_of = [&](Index number) {
    return number < 0 ? std::string(kNoImage) : images[static_cast<std::size_t>(number)];
  };
  const auto for_each_run = [&](const auto& visit) {
    Index before = PlyFaces::kNoTexture;
    for (Index face = 0; face < mesh.face_count(); ++face) {
      const Index number = number_of(face);
      if (number != before) visit(name_of(number), face);
      before = number;
    }
  };
  // A small file can ask for long names at each face.
  constexpr std::size_t kMostTimes = 8;
  std::size_t bytes = 0;
  for_each_run([&](const std::string& name, Index /*face*/) { bytes += name.size() + sizeof(Group); });
  if (bytes / kMostTimes > source.bytes.size()) {
    note(source, "the images of faces are skipped: they change at nearly every face");
    return;
  }
  for_each_run([&](const std::string& name, Index face) { mesh.groups.push_back({"usemtl", name, face}); });
}

PlyTextures ply_textures(const std::string& file, const Mesh& mesh) {
  PlyTextures textures;
  const Materials materials = find_materials(file, mesh);
  std::map<std::string, Index> numbers_of_names;
  Buffer<Index> numbers(static_cast<std::size_t>(mesh.face_count()), PlyFaces::kNoTexture);
  for (const FaceSet& set : faces_by_material(mesh)) {
    const auto material = materials.find(set.name);
    std::string name;
    if (material != materials.end() && material->second.image == nullptr && !material->second.texture.empty()) {
      name = name_in(file, material->second.texture);
    }
    textures.complete = textures.complete && (set.name == name || (name.empty() && set.name == kNoImage));
    if (name.empty()) continue;
    const auto place = numbers_of_names.emplace(name, static_cast<Index>(textures.names.size()));
    if (place.second) textures.names.push_back(name);
    for (const auto& range : set.ranges) {
      std::fill(numbers.begin() + range.first, numbers.begin() + range.second, place.first->second);
    }
  }
  const bool only = std::all_of(numbers.begin(), numbers.end(), [](Index number) { return number == 0; });
  if (textures.names.size() > 1 || (textures.names.size() == 1 && !only)) textures.numbers = std::move(numbers);
  textures.complete = textures.complete && mesh.material_libraries.empty();
  return textures;
}

}  // namespace batten::io
