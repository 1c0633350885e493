#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "batten/mesh/check.h"
#include "batten/parallel/parallel.h"
#include "cli/common.h"

namespace batten::cli {
namespace {

/// "3: 12, 4: 500, 5: 8", the rare ones gathered.
std::string histogram_text(const std::map<Index, Index>& histogram) {
  std::string text;
  std::size_t shown = 0;
  Index rest = 0;
  for (const auto& entry : histogram) {
    if (shown++ < 8) {
      text += fmt::format("{}{}: {}", text.empty() ? "" : ", ", entry.first, grouped(entry.second));
    } else {
      rest += entry.second;
    }
  }
  return rest > 0 ? text + ", more: " + grouped(rest) : text;
}

nlohmann::ordered_json histogram_json(const std::map<Index, Index>& histogram) {
  nlohmann::ordered_json json;
  for (const auto& entry : histogram) json[std::to_string(entry.first)] = entry.second;
  return json;
}

std::map<Index, Index> face_sizes(const Mesh& mesh) {
  std::map<Index, Index> sizes;
  for (Index f = 0; f < mesh.face_count(); ++f) ++sizes[mesh.face_size(f)];
  return sizes;
}

void describe_topology(const Topology& topology, Table& table, nlohmann::ordered_json& json) {
  std::map<Index, Index> interior;
  std::map<Index, Index> boundary;
  Index boundary_edges = 0;
  for (Index v = 0; v < topology.vertex_count(); ++v) {
    if (topology.is_isolated(v)) continue;
    const bool open = topology.is_boundary_vertex(v);
    ++(open ? boundary : interior)[topology.vertex_face_count(v) + (open ? 1 : 0)];
  }
  for (Index e = 0; e < topology.edge_count(); ++e) boundary_edges += topology.is_boundary_edge(e) ? 1 : 0;
  const Index isolated = isolated_count(topology);
  const Index components = connected_components(topology).count - isolated;
  const Index euler = topology.vertex_count() - isolated - topology.edge_count() + topology.face_count();
  table.add("edges", fmt::format("{} ({} on the boundary)", grouped(topology.edge_count()), grouped(boundary_edges)));
  table.add("components", grouped(components));
  if (boundary_edges == 0) table.add("genus", grouped(components - euler / 2));
  table.add("valences", histogram_text(interior));
  if (!boundary.empty()) table.add("at the boundary", histogram_text(boundary));
  json["edges"] = topology.edge_count();
  json["boundary_edges"] = boundary_edges;
  json["components"] = components;
  json["euler_characteristic"] = euler;
  json["isolated_vertices"] = isolated;
  json["valences"] = histogram_json(interior);
  json["boundary_valences"] = histogram_json(boundary);
}

}  // namespace

int run_info(const CommonArguments& arguments) {
  const ThreadLimit limit(arguments.threads);
  const Mesh mesh = read_input(arguments);
  const std::vector<MeshProblem> problems = check(mesh, 10);
  Table table;
  nlohmann::ordered_json json{{"verb", "info"},
                              {"input", arguments.input},
                              {"vertices", mesh.vertex_count()},
                              {"faces", mesh.face_count()},
                              {"diagonal", bounding_diagonal(mesh.points)},
                              {"face_sizes", histogram_json(face_sizes(mesh))},
                              {"creases", mesh.creases.size()},
                              {"corners", mesh.corners.size()},
                              {"holes", mesh.holes.size()}};
  table.add("vertices", grouped(mesh.vertex_count()));
  table.add("faces", fmt::format("{} ({})", grouped(mesh.face_count()), histogram_text(face_sizes(mesh))));
  table.add("diagonal", fmt::format("{:g}", bounding_diagonal(mesh.points)));
  const auto semi_sharp = std::count_if(mesh.creases.begin(), mesh.creases.end(), [](const Crease& crease) {
    return crease.sharpness > 0.0 && crease.sharpness < kInfiniteSharpness;
  });
  if (!mesh.creases.empty()) {
    table.add("creases", fmt::format("{} ({} semi-sharp)", grouped(static_cast<std::int64_t>(mesh.creases.size())),
                                     grouped(semi_sharp)));
  }
  if (!mesh.corners.empty()) table.add("corners", grouped(static_cast<std::int64_t>(mesh.corners.size())));
  if (!mesh.holes.empty()) table.add("holes", grouped(static_cast<std::int64_t>(mesh.holes.size())));
  if (problems.empty()) {
    describe_topology(Topology(mesh), table, json);
    table.add("surface", scheme_text(choose_scheme(mesh)));
  } else {
    json["problems"] = nlohmann::ordered_json::array();
    for (const MeshProblem& problem : problems) {
      table.add("problem", problem.message);
      json["problems"].push_back(problem.message);
    }
  }
  table.print(arguments);
  write_json(arguments.report, json);
  return 0;
}

}  // namespace batten::cli
