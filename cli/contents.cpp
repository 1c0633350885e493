#include "cli/contents.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "batten/mesh/component_volumes.h"
#include "batten/mesh/measures.h"
#include "cli/text.h"

namespace batten::cli {

namespace {

using Json = nlohmann::ordered_json;

std::string values_text(const Attribute& attribute) {
  return fmt::format("{} at {}", grouped(attribute.values.rows()), attribute.per_corner() ? "corners" : "vertices");
}

/// The row's name for the conventional attributes; others are listed by their own names.
const char* row_name(const std::string& attribute) {
  if (attribute == "uv") return "texture coordinates";
  if (attribute == "normal") return "normals";
  return attribute == "color" ? "colours" : nullptr;
}

/// "3: red, green, blue"; of many the first few.
std::string names_text(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 6;
  std::string text = grouped(static_cast<std::int64_t>(names.size())) + ": ";
  for (std::size_t i = 0; i < std::min(kShown, names.size()); ++i) text += (i > 0 ? ", " : "") + names[i];
  return names.size() > kShown ? text + ", ..." : text;
}

/// The different names of each keyword's groups, in the order of the file.
std::map<std::string, std::vector<std::string>> group_names(const Mesh& mesh) {
  std::map<std::string, std::vector<std::string>> names;
  std::map<std::string, std::map<std::string, bool>> met;
  for (const Group& group : mesh.groups) {
    bool& known = met[group.keyword][group.name];
    if (!known) names[group.keyword].push_back(group.name);
    known = true;
  }
  return names;
}

std::string held_text(double number) {
  return std::isfinite(number) ? fmt::format("{:g}", number) : "too large for doubles; scale the mesh down";
}

}  // namespace

void describe_box(const Mesh& mesh, Table& table, Json& json) {
  const BoundingBox box = bounding_box(mesh.points);
  const Eigen::RowVector3d size = box.high - box.low;
  table.add("box", fmt::format("{:g} x {:g} x {:g}, from ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g})", size[0], size[1],
                               size[2], box.low[0], box.low[1], box.low[2], box.high[0], box.high[1], box.high[2]));
  json["box"] = {{"low", {box.low[0], box.low[1], box.low[2]}}, {"high", {box.high[0], box.high[1], box.high[2]}}};
}

void describe_sizes(const Topology& topology, const Components& components, const Points& points, Table& table,
                    Json& json) {
  const EdgeLengths lengths = edge_lengths(topology, points);
  const double area = surface_area(topology, points);
  const ComponentVolumes volumes = component_volumes(topology, points, components);
  table.add("area", held_text(area));
  if (volumes.closed_count() > 0) {
    table.add("volume", fmt::format("{}, of {}", held_text(volumes.sum()),
                                    count_of(volumes.closed_count(), "closed component", "closed components")));
  }
  table.add("edge lengths", fmt::format("{:g} to {:g}, mean {:g}", lengths.shortest, lengths.longest, lengths.mean));
  json["area"] = area;
  json["closed_components"] = volumes.closed_count();
  json["volume"] = volumes.sum();
  json["edge_lengths"] = {{"shortest", lengths.shortest}, {"mean", lengths.mean}, {"longest", lengths.longest}};
}

void describe_values(const Mesh& mesh, Table& table, Json& json) {
  json["attributes"] = Json::array();
  std::string others;
  for (const Attribute& attribute : mesh.attributes) {
    json["attributes"].push_back({{"name", attribute.name},
                                  {"columns", attribute.values.cols()},
                                  {"at", attribute.per_corner() ? "corners" : "vertices"},
                                  {"rows", attribute.values.rows()}});
    if (const char* name = row_name(attribute.name)) {
      table.add(name, values_text(attribute));
    } else {
      others += (others.empty() ? "" : ", ") + attribute.name;
    }
  }
  if (!others.empty()) table.add("other values", others);
  json["groups"] = Json::object();
  for (const auto& group : group_names(mesh)) {
    json["groups"][group.first] = group.second;
    const std::string& word = group.first;
    const char* name = word == "usemtl" ? "materials" : word == "g" ? "groups" : word == "o" ? "objects" : "smoothing";
    table.add(name, names_text(group.second));
  }
  json["material_libraries"] = mesh.material_libraries;
}

}  // namespace batten::cli
