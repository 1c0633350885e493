/// \file What info tells of a mesh besides its connectivity: sizes, and the values and groups that it carries.
#pragma once
#include <nlohmann/json.hpp>

#include "batten/mesh/topology.h"
#include "cli/table.h"

namespace batten::cli {

/// The box that holds the finite points.
void describe_box(const Mesh& mesh, Table& table, nlohmann::ordered_json& json);
/// Area, volume of the closed components, lengths of the edges.
void describe_sizes(const Topology& topology, const Components& components, const Points& points, Table& table,
                    nlohmann::ordered_json& json);
/// Texture coordinates, normals, colours and other values, groups and materials.
void describe_values(const Mesh& mesh, Table& table, nlohmann::ordered_json& json);

}  // namespace batten::cli
