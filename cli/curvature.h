/// \file What info --curvature tells and writes.
#pragma once
#include <nlohmann/json.hpp>

#include "batten/mesh/topology.h"
#include "batten/scheme/scheme.h"
#include "batten/surface/curvature.h"
#include "cli/table.h"

namespace batten::cli {

/// At the vertices of the mesh; NaN where the surface has none.
using VertexCurvature = Curvature;

/// Of the mesh's limit surface.
VertexCurvature measure_curvature(const Topology& topology, const Scheme& scheme, const Mesh& mesh);

/// The ranges for a person, the numbers for a program.
void describe_curvature(const VertexCurvature& curvature, Table& table, nlohmann::ordered_json& json);

/// Writes the mesh to the output, if there is one, with the attributes "mean_curvature" and "gaussian_curvature" at its
/// vertices, 0 where there is none; OBJ and GLB show the mean curvature as colours besides. Says what the format loses.
void write_curvature(const CommonArguments& arguments, const VertexCurvature& curvature, Mesh mesh, Table& table,
                     nlohmann::ordered_json& json);

}  // namespace batten::cli
