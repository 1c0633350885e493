#include "batten/io/ply_targets.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "batten/parallel/parallel.h"

namespace batten::io {

namespace {

/// The name of the exact colours until settle_ply_colors().
constexpr const char* kExactColor = "exact_color";

/// Properties that together form an attribute.
struct Family {
  const char* attribute;
  std::vector<std::string> properties;
};

const std::vector<Family>& families() {
  // The longer colour comes first: the first complete family takes its properties.
  static const std::vector<Family> known = {{"normal", {"nx", "ny", "nz"}},
                                            {"color", {"red", "green", "blue", "alpha"}},
                                            {"color", {"red", "green", "blue"}},
                                            {kExactColor, {"exact_red", "exact_green", "exact_blue", "exact_alpha"}},
                                            {kExactColor, {"exact_red", "exact_green", "exact_blue"}},
                                            {"uv", {"s", "t"}},
                                            {"uv", {"u", "v"}},
                                            {"uv", {"texture_u", "texture_v"}}};
  return known;
}

/// The index of the scalar property of that name, or -1.
std::ptrdiff_t find_scalar(const PlyElement& element, const std::string& name) {
  const auto found = std::find_if(element.properties.begin(), element.properties.end(),
                                  [&](const PlyProperty& p) { return !p.is_list() && p.name == name; });
  return found == element.properties.end() ? -1 : found - element.properties.begin();
}

/// The index of the list property of that name, or PlyTargets::kNone.
std::size_t find_list(const PlyElement& element, const std::string& name) {
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    if (element.properties[i].is_list() && element.properties[i].name == name) return i;
  }
  return PlyTargets::kNone;
}

/// Lets the values of faces be kept for which a Mesh has a place.
void find_face_values(const PlyHeader& header, PlyTargets& targets) {
  targets.uv_list = find_list(*targets.element, kPlyUvs);
  if (targets.uv_list != PlyTargets::kNone) targets.exact_uv_list = find_list(*targets.element, kPlyExactUvs);
  const std::ptrdiff_t number = find_scalar(*targets.element, kPlyTextureNumber);
  if (number >= 0 && !header.texture_files.empty()) targets.texture_number = static_cast<std::size_t>(number);
}

bool is_face_list(const PlyProperty& property) {
  return property.is_list() && (property.name == "vertex_indices" || property.name == "vertex_index");
}

void require_vertex_properties(const std::string& name, const PlyElement& element) {
  for (const char* coordinate : {"x", "y", "z"}) {
    if (find_scalar(element, coordinate) >= 0) continue;
    throw Error(ErrorCode::BadFile,
                name + ": the vertices have no property '" + coordinate + "'; add it to the header");
  }
  require_index_count(name, element.count, "vertices");
}

/// Colours of integer type range up to 255 (65535); other values are kept.
double divisor(const Family& family, const PlyProperty& property) {
  if (std::string(family.attribute) != "color" || !is_integer(property.type)) return 1.0;
  return property.type == PlyType::Uint16 ? 65535.0 : 255.0;
}

/// Fills the columns of an attribute from the properties with these indices.
struct Placement {
  std::size_t attribute;
  std::vector<std::ptrdiff_t> properties;
};

}  // namespace

std::vector<PlyTargets> find_ply_targets(const std::string& name, const PlyHeader& header) {
  std::vector<PlyTargets> all;
  std::ptrdiff_t vertices = -1;
  bool faces = false;
  bool strips = false;
  for (const PlyElement& element : header.elements) {
    PlyTargets targets;
    targets.element = &element;
    targets.columns.resize(element.properties.size());
    const auto list = std::find_if(element.properties.begin(), element.properties.end(), is_face_list);
    if (element.name == "vertex" && vertices < 0) {
      require_vertex_properties(name, element);
      vertices = static_cast<std::ptrdiff_t>(element.count);
      targets.role = PlyRole::Vertices;
    } else if (element.name == "face" && !faces && list != element.properties.end()) {
      require_index_count(name, element.count, "faces");
      faces = true;
      targets.role = PlyRole::Faces;
      targets.face_list = static_cast<std::size_t>(list - element.properties.begin());
      find_face_values(header, targets);
    } else if (element.name == "tristrips" && !strips && list != element.properties.end()) {
      strips = true;
      targets.role = PlyRole::Strips;
      targets.face_list = static_cast<std::size_t>(list - element.properties.begin());
    } else if ((element.name == "face" || element.name == "tristrips") && element.count > 0) {
      throw Error(ErrorCode::BadFile, name + ": the " + (element.name == "face" ? "faces" : "triangle strips") +
                                          " have no list 'vertex_indices'; add it to the header");
    }
    all.push_back(std::move(targets));
  }
  if (vertices < 0) throw Error(ErrorCode::BadFile, name + ": the header has no element 'vertex'");
  for (PlyTargets& targets : all) targets.vertex_count = static_cast<Index>(vertices);
  return all;
}

void allocate_ply_vertices(PlyTargets& targets, Mesh& mesh) {
  const PlyElement& element = *targets.element;
  const auto rows = static_cast<Eigen::Index>(element.count);
  std::vector<bool> taken(element.properties.size(), false);
  const auto place = [&](std::ptrdiff_t property, double* values, std::ptrdiff_t offset, std::ptrdiff_t stride,
                         double by) {
    targets.columns[property] = {values, offset, stride, by};
    taken[property] = true;
  };
  mesh.points.resize(rows, 3);
  const char* const coordinates[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k) place(find_scalar(element, coordinates[k]), mesh.points.data(), k, 3, 1.0);
  for (const Family& family : families()) {
    std::vector<std::ptrdiff_t> found;
    for (const std::string& property : family.properties) found.push_back(find_scalar(element, property));
    if (std::any_of(found.begin(), found.end(), [&](std::ptrdiff_t p) { return p < 0 || taken[p]; })) continue;
    const bool repeated = std::any_of(mesh.attributes.begin(), mesh.attributes.end(),
                                      [&](const Attribute& a) { return a.name == family.attribute; });
    if (repeated) continue;
    const auto columns = static_cast<Eigen::Index>(found.size());
    mesh.attributes.push_back({family.attribute, Values(rows, columns), {}});
    double* values = mesh.attributes.back().values.data();
    for (std::size_t k = 0; k < found.size(); ++k) {
      place(found[k], values, static_cast<std::ptrdiff_t>(k), columns, divisor(family, element.properties[found[k]]));
    }
  }
  for (std::size_t p = 0; p < element.properties.size(); ++p) {
    if (taken[p] || element.properties[p].is_list()) continue;
    // A scalar of that name is no normal, and no writer would accept it as one.
    const std::string& name = element.properties[p].name;
    const bool reserved = name == "normal" || name == "color" || name == "uv";
    mesh.attributes.push_back({reserved ? name + "_" : name, Values(rows, 1), {}});
    place(static_cast<std::ptrdiff_t>(p), mesh.attributes.back().values.data(), 0, 1, 1.0);
  }
}

void settle_ply_colors(Mesh& mesh) {
  const auto find = [&](const char* name) {
    return std::find_if(mesh.attributes.begin(), mesh.attributes.end(),
                        [&](const Attribute& a) { return a.name == name && a.values.cols() >= 3; });
  };
  const auto exact = find(kExactColor);
  const auto bytes = find("color");
  if (exact == mesh.attributes.end()) return;
  if (bytes == mesh.attributes.end()) {
    exact->name = "color";
    return;
  }
  const double* given = bytes->values.data();
  const double* precise = exact->values.data();
  const bool agree = bytes->values.cols() == exact->values.cols() &&
                     parallel_all_of(exact->values.size(), [&](std::ptrdiff_t begin, std::ptrdiff_t end) {
                       for (std::ptrdiff_t i = begin; i < end; ++i) {
                         if (color_byte(given[i]) != color_byte(precise[i])) return false;
                       }
                       return true;
                     });
  if (agree) bytes->values = std::move(exact->values);
  mesh.attributes.erase(exact);
}

}  // namespace batten::io
